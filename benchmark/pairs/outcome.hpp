#pragma once

namespace fiber {

/// What became of asking a kernel.
enum class Outcome {
  ENDED,       ///< the process aborted, or was ended after a second of computing
  NO_ANSWER,   ///< an exception
  NOT_FINITE,  ///< a number that is none
  ANSWERED
};

}  // namespace fiber
