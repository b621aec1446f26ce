#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/query/motion.hpp"

namespace fiber {

/// Candidates that one thread looks at at a time.
constexpr std::size_t motions_per_slice = 512;

/// What one thread finds at a time.
struct MotionSlice {
  std::vector<ContactTime> times;  // work memory
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

/// Makes a result the answer about candidates of which none has been judged.
void begin_result(const MotionCandidates& candidates, MotionResult& result);

/// Adds what was found of a slice. Slices come in the order of their candidates.
void append(const MotionSlice& slice, MotionResult& result);

/// Leaves what the options ask for, once all slices are there.
void finish_result(const MotionCandidates& candidates, const MotionOptions& options,
                   MotionResult& result);

}  // namespace fiber
