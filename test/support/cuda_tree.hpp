#pragma once

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/query/engine.hpp"
#include "src/cuda/cuda_tree_engine.hpp"
#include "src/cuda/device.hpp"

namespace fiber::test {

/// Makes `cuda_tree` known: with its kernels as loops on this processor, or, where
/// FIBER_PROXIMITY_TEST_GPU is set, on a GPU (scripts/check_gpu.sh).
inline void register_cuda_tree() {
  EngineFamily family;
  family.names = {"cuda_tree"};
  family.make = [](const std::string& name,
                   const EngineOptions& options) -> std::unique_ptr<ProximityEngine> {
    if (name != "cuda_tree") {
      return nullptr;
    }
    const bool is_on_gpu = std::getenv("FIBER_PROXIMITY_TEST_GPU") != nullptr;
    return std::make_unique<CudaTreeEngine>(is_on_gpu ? make_cuda_device() : make_host_device(),
                                            options);
  };
  [[maybe_unused]] static const bool is_registered = register_engines(family);
}

/// These names of engines, and that of `cuda_tree` if it is not among them, which is known then.
inline std::vector<std::string> with_cuda_tree(std::vector<std::string> names) {
  register_cuda_tree();
  if (std::find(names.begin(), names.end(), "cuda_tree") == names.end()) {
    names.emplace_back("cuda_tree");
  }
  return names;
}

}  // namespace fiber::test
