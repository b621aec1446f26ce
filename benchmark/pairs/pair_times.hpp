#pragma once

#include <cstdint>
#include <vector>

#include "pairs/pair_kernel.hpp"

namespace fiber {

/// A kernel and the pairs it is measured on.
struct TimedKernel {
  PairKernel* kernel;
  std::vector<HardPair> pairs;
};

/// Times per call of each kernel [ns], one of each block of 32 different pairs that are asked about
/// together, or of each pair of a kernel that mostly takes more than 1 µs: a clock cannot tell
/// less, and one pair asked about again and again would be guessed by the processor. A kernel's
/// blocks take turns with those of the others, and each is asked about once before it is timed, as
/// the others have filled the caches. Each time is the median of its repeats, without the clock's
/// own. Empty of a kernel without pairs.
///
/// All this is in a child process. Where a kernel ends it, as some do that went well before, its
/// pairs of that turn are left out and all begin again.
std::vector<std::vector<double>> pair_times_ns(std::vector<TimedKernel> kernels,
                                               std::uint32_t repeats);

}  // namespace fiber
