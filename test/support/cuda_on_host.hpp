#pragma once

#include <memory>
#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "src/cuda/cuda_tree_engine.hpp"
#include "src/cuda/device.hpp"

namespace fiber::test {

/// Makes `cuda_tree` known with its kernels as loops on this processor: the engine without a GPU.
inline void register_cuda_on_host() {
  EngineFamily family;
  family.names = {"cuda_tree"};
  family.make = [](const std::string& name,
                   const EngineOptions& options) -> std::unique_ptr<ProximityEngine> {
    return name == "cuda_tree" ? std::make_unique<CudaTreeEngine>(make_host_device(), options)
                               : nullptr;
  };
  [[maybe_unused]] static const bool is_registered = register_engines(family);
}

}  // namespace fiber::test
