#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"

namespace fiber {

/// FCL's DynamicAABBTreeCollisionManager over the segments of fibres, for margins up to one that is
/// known beforehand: FCL's boxes are what holds the margin.
class FclBroadPhase {
 public:
  FclBroadPhase() = default;
  FclBroadPhase(const FclBroadPhase&) = delete;
  FclBroadPhase& operator=(const FclBroadPhase&) = delete;
  virtual ~FclBroadPhase() = default;

  /// Refits the tree to moved points, or builds it for other fibres.
  virtual void update(const FiberAssembly& fibers, bool same_topology) = 0;

  /// Offers each pair of segments whose boxes overlap once.
  virtual void collide(PairCollector& collector) const = 0;
};

/// The result of fcl::distance() for two segments.
struct FclDistance {
  PointPair pair{};  ///< the smaller one first
  double gap = 0.0;  ///< [m] of the surfaces, negative in penetration; NaN: no answer
};

/// The segments as users of FCL write them: a Capsule each, rotated and moved into place, in the
/// box that FCL gives it (of the sphere around it unless it is upright).
class FclCapsules : public FclBroadPhase {
 public:
  /// Measures all pairs whose boxes overlap and that are no neighbours, with fcl::distance()
  /// unsigned: FCL's own algorithm for two capsules, whose result is negative in penetration all
  /// the same. It has nothing in it that could end the process. Asked for a distance with a sign
  /// FCL takes GJK and EPA: these trip over assertions, which Debian's libfcl has on, for every two
  /// capsules that are one point, and now and then elsewhere (docs/numerics.md).
  /// @param found the pairs within the test's margin and those without an answer, in no order
  /// @return number of pairs that were measured
  virtual std::uint64_t measure(const NarrowPhase& test, std::vector<FclDistance>& found) const = 0;
};

/// FCL's tree over our own boxes: FCL offers no other way to give a rotated object a tight one.
/// @param margin [m] finite, >= 0
std::unique_ptr<FclBroadPhase> make_fcl_boxes(double margin);

/// @param margin [m] finite, >= 0
std::unique_ptr<FclCapsules> make_fcl_capsules(double margin);

}  // namespace fiber
