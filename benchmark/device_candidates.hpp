#pragma once

#include <cstdint>
#include <string>

#include "src/tools/command_line.hpp"

namespace fiber {

/// Candidates of a planner on a GPU, beside check_fibers() on the processor's threads.
struct CandidateRequest {
  std::uint32_t count = 10000;  ///< at least 1
  std::uint32_t cables = 10;    ///< of each candidate, at least 1
  std::uint32_t points = 100;   ///< of each cable, at least 2
  std::uint32_t still = 1;      ///< cables that stand still
  double radius = 0.002;        ///< [m]
  std::string device = "gpu";   ///< or host
  std::uint32_t threads = 1;    ///< of check_fibers()
  std::uint32_t repeats = 11;   ///< at least 1
  bool json = false;
};

/// Prints medians, as a table or JSON.
/// @return DISAGREED where the two have other answers
ExitCode measure_candidates(const CandidateRequest& request);

}  // namespace fiber
