#pragma once

#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "validation/geometry/hard_pairs.hpp"

namespace fiber {

/// What a kernel says of a pair of capsules.
struct PairAnswer {
  double distance = std::numeric_limits<double>::quiet_NaN();  ///< of the axes [m]
  double lower = -std::numeric_limits<double>::infinity();  ///< [m] the true one is at least this
  double upper = std::numeric_limits<double>::infinity();   ///< [m] and at most this
  bool contact = false;  ///< whether the kernel takes them for a contact, used as it should be
};

/// A way to compute the distance of two capsules, one of ours or of another library.
class PairKernel {
 public:
  PairKernel() = default;
  PairKernel(const PairKernel&) = delete;
  PairKernel& operator=(const PairKernel&) = delete;
  virtual ~PairKernel() = default;

  /// Makes of the pairs what the kernel works on. This is not measured: whoever uses another
  /// library has its objects. The pairs live until the next call.
  virtual void prepare(const std::vector<HardPair>& pairs) = 0;

  /// Distances of the axes of `count` pairs from the one with index `first` on [m], something not
  /// finite where there is no answer. This is measured.
  virtual void distances(std::size_t first, std::size_t count, double* distances) = 0;

  /// All that the kernel has to say about a pair.
  /// @throws std::exception if it has no answer
  virtual PairAnswer answer(std::size_t index) = 0;
};

/// The kernel of this name, by make_kernel().
std::unique_ptr<PairKernel> make_pair_kernel(const std::string& name);

/// Names of the kernels in this build.
std::vector<std::string> pair_kernel_names();

}  // namespace fiber
