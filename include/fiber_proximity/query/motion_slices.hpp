#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/query/motion.hpp"

namespace fiber {

/// Candidates that one thread looks at at a time.
constexpr std::size_t motions_per_slice = 512;

/// What one thread finds at a time.
struct MotionSlice {
  std::vector<MotionContact> contacts;
  std::vector<MotionContact> touching;
  bool complete = true;
};

/// Pairs that may come into contact during a motion.
struct MotionCandidates {
  std::vector<std::uint64_t> keys;  ///< see key_of(); in ascending order
  bool are_all = true;              ///< false: the deadline has passed
  bool are_too_many = false;        ///< more than may be examined: there are none
  QueryCounts counts;
};

/// Puts together what was found of the candidates, slice by slice, and leaves what the options ask
/// for.
/// @param result its lists must be empty
void merge_slices(const MotionSlice* slices, std::size_t count, const MotionCandidates& candidates,
                  const MotionOptions& options, MotionResult& result);

}  // namespace fiber
