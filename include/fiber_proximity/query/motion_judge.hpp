#pragma once

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/motion_slices.hpp"
#include "fiber_proximity/query/pair_test.hpp"
#include "fiber_proximity/query/query_limits.hpp"

namespace fiber {

/// Fibres before and after a motion.
struct FiberMotion {
  const FiberAssembly& before;
  const FiberAssembly& after;
};

/// When each candidate comes into contact, slice by slice on several threads, and which of these
/// the options ask for. The same for any number of threads.
/// @param a, b of the first and the second segments of pairs, the same for fibres with each other
/// @param test of the fibres before the motion
void judge_motion(const MotionCandidates& candidates, const FiberMotion& a, const FiberMotion& b,
                  const PairTest& test, const MotionOptions& options, const QueryLimits& limits,
                  MotionResult& result);

}  // namespace fiber
