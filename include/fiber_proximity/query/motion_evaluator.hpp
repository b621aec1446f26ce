#pragma once

#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/motion_slices.hpp"
#include "fiber_proximity/query/narrow_phase.hpp"
#include "fiber_proximity/query/query_limits.hpp"

namespace fiber {

/// Fibres before and after a motion.
struct FiberMotion {
  const FiberAssembly& before;
  const FiberAssembly& after;
};

/// Finds when candidates come into contact, slice by slice on several threads. Gives the same for
/// any number of threads. Keeps its memory from query to query.
class MotionEvaluator {
 public:
  /// @param a, b of the first and the second segments of pairs, the same for fibres with each other
  /// @param test of the fibres before the motion
  /// @param result its lists must be empty
  void evaluate(const MotionCandidates& candidates, const FiberMotion& a, const FiberMotion& b,
                const NarrowPhase& test, const MotionOptions& options, const QueryLimits& limits,
                MotionResult& result);

 private:
  std::vector<ContactTime> times_;  // of a round
  std::vector<MotionSlice> slices_;
};

}  // namespace fiber
