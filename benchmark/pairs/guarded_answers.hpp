#pragma once

#include <vector>

#include "pairs/pair_kernel.hpp"

namespace fiber {

/// What became of asking a kernel about a pair.
enum class Outcome {
  ENDED,       ///< the process aborted, or was ended after a second of computing
  NO_ANSWER,   ///< an exception
  NOT_FINITE,  ///< a distance that is none
  ANSWERED
};

struct GuardedAnswer {
  Outcome outcome = Outcome::ENDED;
  PairAnswer answer;  ///< if it is ANSWERED
};

/// Asks a kernel about `count` pairs that it has been prepared for, in a child process, as some
/// libraries abort: after such an end, another child goes on with the next pair. No other thread
/// may be running.
/// @throws std::runtime_error if there are no more processes or memory
std::vector<GuardedAnswer> guarded_answers(PairKernel& kernel, std::size_t count);

}  // namespace fiber
