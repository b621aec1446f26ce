#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/pair_test.hpp"
#include "fiber_proximity/query/query_limits.hpp"

namespace fiber {

/// Fibres before and after a motion.
struct FiberMotion {
  const FiberAssembly& before;
  const FiberAssembly& after;
};

/// Pairs that may come into contact during a motion.
struct MotionCandidates {
  std::vector<std::uint64_t> keys;  ///< see key_of(); in ascending order
  bool are_all = true;              ///< false: the deadline has passed
  bool are_too_many = false;        ///< more than may be examined: there are none
  QueryCounts counts;
};

/// Finds when candidates come into contact, slice by slice on several threads. Gives the same for
/// any number of threads. Keeps its memory from query to query.
class MotionJudge {
 public:
  /// @param a, b of the first and the second segments of pairs, the same for fibres with each other
  /// @param test of the fibres before the motion
  /// @param result replaced, its contacts by those that the options ask for
  void judge(const MotionCandidates& candidates, const FiberMotion& a, const FiberMotion& b,
             const PairTest& test, const MotionOptions& options, const QueryLimits& limits,
             MotionResult& result);

 private:
  /// What one thread finds at a time.
  struct Slice {
    std::vector<ContactTime> times;
    std::vector<MotionContact> contacts;
    std::vector<MotionContact> touching;
    bool complete = true;
  };

  std::vector<Slice> slices_;  // of a round
};

}  // namespace fiber
