#include "fiber_proximity/cuda/cuda_engines.hpp"

#include <stdexcept>

#include "fiber_proximity/query/engine.hpp"
#include "src/cuda/cuda_tree_engine.hpp"
#include "src/cuda/device.hpp"

namespace fiber {

void register_cuda_engines() {
  EngineFamily family;
  if (missing_cuda().empty()) {
    family.names = {"cuda_tree"};
  }
  family.make = [](const std::string& name,
                   const EngineOptions& options) -> std::unique_ptr<ProximityEngine> {
    if (name != "cuda_tree") {
      return nullptr;
    }
    if (!missing_cuda().empty()) {
      throw std::invalid_argument(missing_cuda());
    }
    return std::make_unique<CudaTreeEngine>(make_cuda_device(), options);
  };
  // Once in a process, whoever calls and on however many threads.
  [[maybe_unused]] static const bool is_registered = register_engines(std::move(family));
}

}  // namespace fiber
