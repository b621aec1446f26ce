#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "benchmark/kernels/guarded.hpp"
#include "benchmark/kernels/kernel.hpp"
#include "validation/geometry/hard_pairs.hpp"

namespace fiber {

/// The answer of a kernel to a pair of capsules.
struct PairAnswer {
  double distance = std::numeric_limits<double>::quiet_NaN();  ///< of the axes [m]
  double lower = -std::numeric_limits<double>::infinity();  ///< [m] the true one is at least this
  double upper = std::numeric_limits<double>::infinity();   ///< [m] and at most this
  bool contact = false;  ///< whether the kernel takes them for a contact, used as it should be
};

/// A way to compute the distance of the axes of two capsules [m], something not finite where there
/// is no answer.
class PairKernel : public BenchmarkKernel<HardPair, double> {
 public:
  /// All that the kernel has to say about a pair.
  /// @throws std::exception if it has no answer
  virtual PairAnswer answer(std::size_t index) = 0;
};

/// Asks a kernel about `count` pairs that it has been prepared for, by guarded_calls().
std::vector<Guarded<PairAnswer>> guarded_answers(PairKernel& kernel, std::size_t count);

/// The kernel of this name, by make_kernel().
std::unique_ptr<PairKernel> make_pair_kernel(const std::string& name);

/// Names of the kernels in this build.
std::vector<std::string> pair_kernel_names();

}  // namespace fiber
