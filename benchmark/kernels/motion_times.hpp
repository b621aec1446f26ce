#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "benchmark/kernels/decision_score.hpp"
#include "benchmark/kernels/motion_kernel.hpp"

namespace fiber {

/// A kernel and the tolerance it is asked with [m].
struct MotionContestant {
  std::function<std::unique_ptr<MotionKernel>()> make;
  double tolerance = 0.0;
};

/// The answers of a contestant, and its times.
struct MotionKernelResult {
  std::uint64_t translations = 0;  ///< motions of rigid bodies
  std::uint64_t answerable = 0;    ///< motions that the kernel knows; of these:
  std::uint64_t contacts = 0;      ///< they surely touch
  std::uint64_t near = 0;          ///< others that may come within the tolerance
  std::uint64_t undecided = 0;     ///< of which the truth could not be found
  DecisionScore score;
  std::uint64_t rejected = 0;  ///< measured: motions that do not come near
  std::uint64_t hits = 0;      ///< measured: motions that surely touch

  /// Time per motion, over blocks of 256 [ns]; none without motions.
  std::optional<double> rejected_ns;
  std::optional<double> hit_ns;
};

/// Asks all contestants about the same motions, in child processes, and holds their answers against
/// the truth. Then measures them in turns on what they survived. No other thread may be running.
std::vector<MotionKernelResult> motion_results(const std::vector<HardMotion>& motions,
                                               const std::vector<MotionContestant>& contestants,
                                               std::uint32_t repeats);

}  // namespace fiber
