#include "fiber_proximity/cuda/cuda_engines.hpp"

#include <stdexcept>

#include "fiber_proximity/query/engine.hpp"
#include "src/cuda/cuda_tree_engine.hpp"
#include "src/cuda/device.hpp"

namespace fiber {

void register_cuda_engines() {
  EngineFamily family;
  if (has_cuda()) {
    family.names = {"cuda_tree"};
  }
  family.make = [](const std::string& name,
                   const EngineOptions& options) -> std::unique_ptr<ProximityEngine> {
    if (name != "cuda_tree") {
      return nullptr;
    }
    if (!has_cuda()) {
      throw std::invalid_argument("this build is without it: CUDA's compiler was not found for it");
    }
    return std::make_unique<CudaTreeEngine>(make_cuda_device(), options);
  };
  // Once in a process, whoever calls and on however many threads.
  [[maybe_unused]] static const bool is_registered = register_engines(std::move(family));
}

}  // namespace fiber
