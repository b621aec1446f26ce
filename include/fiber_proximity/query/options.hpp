#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Which of the pairs within the margin to report.
enum class QueryType {
  FIRST,       ///< any one; which one depends on the engine, the same on every run
  CLOSEST,     ///< the closest one; ties go to the smallest segment indices
  LIMITED,     ///< the max_contacts closest ones
  ALL,         ///< all of them
  FIBER_PAIRS  ///< the closest one of each pair of fibres, a fibre with itself too; ties as above
};

/// Which pairs of one assembly count, by their fibres.
enum class Pairing {
  ALL,
  SAME_FIBER,       ///< self-contacts only
  DIFFERENT_FIBERS  ///< no self-contacts
};

/// Which pairs of segments a query or a question about a motion is about, and what it may cost.
struct PairOptions {
  /// [m] Pairs with a signed distance of at most this are contacts; >= 0, infinity for no limit.
  double margin = 0.0;

  /// LIMITED only: the most contacts to report, at least 1.
  std::uint32_t max_contacts = 100;

  Pairing pairing = Pairing::ALL;

  // Which segments of one fibre, or of fibres that are joined, are pairs. With none of the next two
  // set: those that a loop is between (LoopTest), whatever the margin and however finely the fibre
  // is sampled.

  /// Segments of one fibre whose indices differ by at most this are no pair; the rule of loops does
  /// not apply. 1 leaves out the neighbours that share a point; 0 reports even those. Where fibres
  /// are closed or joined it counts along the shortest way: 1 for segments that share a joint. If
  /// only neighbour_skip_length is set, this counts as 1.
  std::optional<std::uint32_t> neighbour_skip;

  /// [m] Segments of one fibre with less than this arc length between them are no pair; >= 0, 0 for
  /// no such limit; the rule of loops does not apply. Where fibres are closed or joined it is the
  /// length of the shortest way. If only neighbour_skip is set, this counts as 0.
  std::optional<double> neighbour_skip_length;

  /// Whether self-contacts need a loop.
  bool needs_loops() const { return !neighbour_skip && !neighbour_skip_length; }

  /// [s] Time from the start of the query after which it answers with what it has found; >= 0, 0
  /// for none. QueryResult::complete tells whether it was enough. Where it is not, a part of it
  /// goes to deciding about what has been found.
  double deadline = 0.0;

  /// ALL, LIMITED and FIBER_PAIRS: the most contacts to report, 0 for no limit. Where there are
  /// more, the closest ones are reported, ties by smallest indices, and QueryResult::limit_reached
  /// is set. Bounds the memory of a query whose answer nobody has foreseen.
  std::uint32_t contact_limit = 0;

  /// The most pairs of segments to examine, 0 for no limit: where more come up, the query answers
  /// with what it has found among the first ones. QueryResult::complete is then false, as by a
  /// deadline, and limit_reached set. Bounds the time where nearly all is near all; unlike a
  /// deadline it gives the same on every run, for any number of threads. Engines differ in which
  /// pairs come up.
  std::uint64_t pair_limit = 0;
};

/// The options of a query.
struct QueryOptions : PairOptions {
  QueryType type = QueryType::ALL;

  /// How distances are computed, and which pairs are within the margin. ROBUST goes by the distance
  /// it computes. EXACT decides without any error, and reports distances that are rounded
  /// correctly, before the radii are subtracted.
  Kernel kernel = Kernel::ROBUST;

  /// CLOSEST, LIMITED and FIBER_PAIRS: a pair need not be looked for that is closer, or deeper,
  /// than a reported one by less than this [m]; >= 0. Which pair is reported then depends on the
  /// engine.
  double tolerance = 0.0;

  /// Tolerance as a part of the distance; >= 0. The larger of both counts: a distance d is reported
  /// where the closest is at least d − |d|·ρ / (1 + ρ), where ρ is this. For d ≥ 0 that is
  /// d / (1 + ρ). In penetration a depth is reported where the greatest is at most 1 + ρ times as
  /// much, and less than twice.
  double relative_tolerance = 0.0;
};

/// @throws std::invalid_argument naming the field, its value and what is allowed
void validate(const QueryOptions& options);

/// The type of this name: first, closest, limited, all or fiber_pairs.
/// @throws std::invalid_argument listing the names
QueryType query_type_from_name(const std::string& name);

/// The pairing of this name: all, same_fiber or different_fibers.
/// @throws std::invalid_argument listing the names
Pairing pairing_from_name(const std::string& name);

/// When to answer. May be asked from several threads at once.
class Deadline {
 public:
  /// @param seconds from now; 0 for none
  explicit Deadline(double seconds)
      : seconds_(seconds), start_(seconds > 0.0 ? Clock::now() : Clock::time_point()) {}

  bool is_set() const { return seconds_ > 0.0; }

  /// Whether this part of the time has passed, but for what is needed yet [s]. Without a deadline
  /// it costs nothing.
  bool has_passed(double part = 1.0, double needed = 0.0) const {
    return is_set() && elapsed() >= part * seconds_ - needed;
  }

  /// [s] For a deadline of what comes next: at least a nanosecond, 0 if there is none.
  double left() const {
    constexpr double shortest = 1e-9;
    return is_set() ? std::max(seconds_ - elapsed(), shortest) : 0.0;
  }

 private:
  using Clock = std::chrono::steady_clock;

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  double seconds_;
  Clock::time_point start_;
};

}  // namespace fiber
