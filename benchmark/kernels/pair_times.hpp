#pragma once

#include <cstdint>
#include <vector>

#include "benchmark/kernels/pair_kernel.hpp"

namespace fiber {

/// A kernel and the pairs it is measured on.
struct TimedKernel {
  PairKernel* kernel;
  std::vector<HardPair> pairs;
};

/// Times per call of each kernel [ns], by turn_times(): one of each block of 32 different pairs
/// that are asked about together, or of each pair of a kernel that mostly takes more than 1 µs. A
/// clock cannot tell less, and one pair asked about again and again would be guessed by the
/// processor.
std::vector<std::vector<double>> pair_times_ns(std::vector<TimedKernel> kernels,
                                               std::uint32_t repeats);

}  // namespace fiber
