#pragma once

#include <cstdint>
#include <string>

namespace fiber {

/// Which of the pairs within the margin to report.
enum class QueryType {
  FIRST,       ///< any one; which one depends on the engine, the same on every run
  CLOSEST,     ///< the closest one; ties go to the smallest segment indices
  LIMITED,     ///< the max_contacts closest ones
  ALL,         ///< all of them
  FIBER_PAIRS  ///< the closest one of each pair of fibres, a fibre with itself too; ties as above
};

struct QueryOptions {
  QueryType type = QueryType::ALL;

  /// [m] Pairs with a signed distance of at most this are contacts; >= 0, infinity for no limit.
  double margin = 0.0;

  /// LIMITED only: the most contacts to report, at least 1.
  std::uint32_t max_contacts = 100;

  /// Segments of one fibre whose indices differ by at most this are no pair. 1 leaves out the
  /// neighbours that share a point; 0 reports even those.
  std::uint32_t neighbour_skip = 1;

  /// [m] Segments of one fibre with less than this arc length between them are no pair; >= 0,
  /// 0 for no such limit. Needed where segments are shorter than the fibre is thick.
  double neighbour_skip_length = 0.0;

  /// Test the volumes of two leaves before the segments themselves; changes only the cost. The
  /// paper finds that it always pays (Sect. 5). run_tree always does.
  bool leaf_pretest = true;
};

/// @throws std::invalid_argument naming the field, its value and what is allowed
void validate(const QueryOptions& options);

/// The type of this name: first, closest, limited, all or fiber_pairs.
/// @throws std::invalid_argument listing the names
QueryType query_type_from_name(const std::string& name);

}  // namespace fiber
