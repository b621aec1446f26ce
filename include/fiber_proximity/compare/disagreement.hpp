#pragma once

#include <cstdint>
#include <optional>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/narrow_phase.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// Whose answer about a pair holds, as far as its error permits.
enum class Verdict {
  BOTH,    ///< they differ by less than what they are rounded by
  OURS,    ///< ours alone
  FCL,     ///< FCL's alone
  NEITHER  ///< none
};

/// both, ours, fcl or neither
const char* name_of(Verdict verdict);

/// What one side says of a pair. Its bounds are what its error permits the truth to be.
struct PairClaim {
  double gap = 0.0;    ///< [m] of the surfaces
  double lower = 0.0;  ///< [m] the true gap should be at least this
  double upper = 0.0;  ///< [m] and at most this
};

/// A pair of which one side alone says that it is within the margin, or whose distances differ by
/// more than both errors permit.
struct Disagreement {
  SegmentId a;
  SegmentId b;
  std::optional<PairClaim> ours;  ///< none: no contact
  std::optional<PairClaim> fcl;   ///< none: no contact
  bool fcl_has_answer = true;     ///< false: not even that; FCL threw, or its distance is no number
  double gap = 0.0;               ///< [m] from the exact distance, rounded three times
  bool is_contact = false;        ///< whether the exact gap is at most the margin
  Verdict verdict = Verdict::BOTH;
};

/// What FCL's distance of two capsules may be wrong by: 16 roundings of the largest coordinate and
/// the radii. FCL gives no error. It works on world coordinates and rotations, so no better can be
/// expected of it; on pairs that are neither tiny nor almost parallel it is as good [m].
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

}  // namespace fiber
