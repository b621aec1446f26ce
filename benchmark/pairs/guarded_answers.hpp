#pragma once

#include <vector>

#include "benchmark/pairs/outcome.hpp"
#include "benchmark/pairs/pair_kernel.hpp"

namespace fiber {

struct GuardedAnswer {
  Outcome outcome = Outcome::ENDED;
  PairAnswer answer;  ///< if it is ANSWERED
};

/// Asks a kernel about `count` pairs that it has been prepared for, by guarded_calls(). No other
/// thread may be running.
/// @throws std::runtime_error if there are no more processes or memory
std::vector<GuardedAnswer> guarded_answers(PairKernel& kernel, std::size_t count);

}  // namespace fiber
