#include <stdexcept>

#include "src/cuda/device.hpp"

namespace fiber {

bool has_cuda() { return false; }

std::unique_ptr<Device> make_cuda_device() {
  throw std::runtime_error("cuda_tree is not in this build: CUDA's compiler was not found for it");
}

}  // namespace fiber
