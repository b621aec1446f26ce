#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/compare/fcl_comparer.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/for_engines/narrow_phase.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// The error that FCL's distance of two capsules may have: 16 roundings of the largest coordinate
/// and the radii. FCL gives no error. It works on world coordinates and rotations, so no better can
/// be expected of it; on pairs that are neither tiny nor almost parallel it is as good [m].
double fcl_error(const Capsule& a, const Capsule& b);

/// Judges pairs by their exact distance.
class PairOracle {
 public:
  /// @param options of the query that ours answered; type ALL. Both must outlive this.
  PairOracle(const FiberAssembly& fibers, const QueryOptions& options);

  /// The truth about an ordered pair, and who is right. The claims are taken as they are, whether
  /// they disagree or not.
  Disagreement judge(PointPair pair, const std::optional<PairClaim>& ours,
                     const std::optional<PairClaim>& fcl, bool fcl_has_answer) const;

  /// The segment that starts at this point.
  SegmentId segment(std::uint32_t point) const { return fibers_.segment_id(point); }

 private:
  bool ours_is_right(PointPair pair, const Disagreement& found) const;
  bool fcl_is_right(PointPair pair, const Disagreement& found) const;
  bool gap_is_at_most(PointPair pair, double limit) const;
  bool gap_is_at_least(PointPair pair, double limit) const;
  bool gap_is_within(PointPair pair, const PairClaim& claim) const;

  const FiberAssembly& fibers_;
  const QueryOptions& options_;
  const NarrowPhase test_;
};

/// A contact by the first points of its segments.
struct PairAnswered {
  PointPair pair{};        ///< the smaller one first
  bool has_answer = true;  ///< false: nothing is known of the pair
  PairClaim claim;
};

/// Compares two lists of contacts.
/// @param ours, fcl sorted by their pairs, each pair once
/// @param comparison its counts, differences and disagreements are set; the others are left alone
void compare(const PairOracle& oracle, const std::vector<PairAnswered>& ours,
             const std::vector<PairAnswered>& fcl, StyleComparison& comparison);

}  // namespace fiber
