#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Two segments, by fibre and index along it. Fibres spread over ranks have 64-bit indices.
template <class Index>
struct BasicSegmentIdPair {
  Index fiber_a = 0;
  Index segment_a = 0;
  Index fiber_b = 0;
  Index segment_b = 0;

  /// The key that contacts are sorted by.
  auto key() const { return std::tie(fiber_a, segment_a, fiber_b, segment_b); }
};
using SegmentIdPair = BasicSegmentIdPair<std::uint32_t>;

/// SegmentIdPair::key() for algorithms.
inline constexpr auto by_key = [](const auto& x, const auto& y) { return x.key() < y.key(); };

/// A pair of segments and where they are nearest.
template <class Index>
struct BasicContact : BasicSegmentIdPair<Index> {
  double s = 0.0;           ///< curve parameter on segment a, in [0, 1]
  double t = 0.0;           ///< curve parameter on segment b, in [0, 1]
  double distance = 0.0;    ///< signed gap of the surfaces, negative in penetration [m]
  double lower = 0.0;       ///< the true gap is at least this [m]
  double upper = 0.0;       ///< and at most this [m]
  Eigen::Vector3d point_a;  ///< nearest point on the surface of a [m]
  Eigen::Vector3d point_b;  ///< nearest point on the surface of b [m]
  Eigen::Vector3d normal;   ///< unit vector from a to b: (point_b − point_a)·normal = distance

  /// Closer than another; of the same distance, of smaller indices.
  bool closer_than(const BasicContact& other) const {
    return distance < other.distance || (distance == other.distance && this->key() < other.key());
  }
};
using Contact = BasicContact<std::uint32_t>;

/// Contact::closer_than for algorithms.
inline constexpr auto closer = [](const auto& x, const auto& y) { return x.closer_than(y); };

/// Sorts by SegmentIdPair::key(), as results have them.
void sort_by_key(std::vector<Contact>& contacts);

/// Sorts the closest one first.
void sort_by_distance(std::vector<Contact>& contacts);

struct QueryOptions;
struct QueryResult;

/// Leaves the closest ones of a result's contacts, in any order, the farthest of them last. Those
/// that go count in others_lower.
/// @return whether any go
bool keep_closest(std::size_t count, QueryResult& result);

/// Work a query did. The paper's "cage tests", "cage intersections" and "primitive tests".
struct QueryCounts {
  std::uint64_t node_tests = 0;
  std::uint64_t node_overlaps = 0;
  std::uint64_t primitive_tests = 0;

  QueryCounts& operator+=(const QueryCounts& more) {
    node_tests += more.node_tests;
    node_overlaps += more.node_overlaps;
    primitive_tests += more.primitive_tests;
    return *this;
  }
};

/// Answer to a query; kept by the caller and reused, so that its memory is.
struct QueryResult {
  std::vector<Contact> contacts;  ///< sorted by SegmentIdPair::key()

  /// LIMITED reported max_contacts: there may be more pairs. Or there were more than the options'
  /// contact_limit or pair_limit allows.
  bool limit_reached = false;

  /// False: the deadline or the pair_limit came before all pairs had been ruled out.
  bool complete = true;

  /// [m] Of the pairs that were asked about, none that is not reported has a smaller true gap.
  double others_lower = -std::numeric_limits<double>::infinity();

  QueryCounts counts;

  std::vector<std::uint32_t> fiber_pair_slots;  ///< FIBER_PAIRS: work memory, see FiberPairMinima

  /// The reported contact of the smallest distance, nullptr if there is none. The closest pair of
  /// all unless the query was FIRST.
  const Contact* closest() const;

  /// [m] Of all pairs that were asked about, none has a smaller true gap. With the closest()->upper
  /// of a query that looks for the closest pair, this encloses the true minimum.
  double minimum_lower() const;
};

/// How the gap of two segments changes as their end points move [m per m].
struct GapGradient {
  Eigen::Vector3d a0;  ///< start of a
  Eigen::Vector3d a1;  ///< end of a
  Eigen::Vector3d b0;
  Eigen::Vector3d b1;
};

/// Derivatives of Contact::distance by the end points of the axes: −(1−s)·n, −s·n, (1−t)·n and t·n
/// with the normal n from a to b. The nearest points need not be followed as they move: at a
/// minimum the distance does not change with them.
///
/// Where segments are parallel side by side, more than one pair of points is nearest, and this is
/// the derivative of one of these; the gap has a kink there. Where the axes meet, it has one, too,
/// and the normal is any at right angles to both.
inline GapGradient gradient_of(const Contact& contact) {
  const Eigen::Vector3d& n = contact.normal;
  return {(contact.s - 1.0) * n, -contact.s * n, (1.0 - contact.t) * n, contact.t * n};
}

/// Makes one answer of two, about pairs of which none is in both: those that the query asks for
/// among the contacts of both, sorted. What is left out then counts in others_lower.
/// @param more its contacts may be in any order, as those of the result
void merge_results(const QueryOptions& options, const QueryResult& more, QueryResult& result);

}  // namespace fiber
