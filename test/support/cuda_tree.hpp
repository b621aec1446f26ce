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

/// Kernels as loops on this processor, or, where FIBER_PROXIMITY_TEST_GPU is set, a GPU
/// (scripts/check_gpu.sh).
inline std::unique_ptr<Device> make_test_device() {
  return std::getenv("FIBER_PROXIMITY_TEST_GPU") != nullptr ? make_cuda_device()
                                                            : make_host_device();
}

/// Makes `cuda_tree` known, on that device.
inline void register_cuda_tree() {
  EngineFamily family;
  family.names = {"cuda_tree"};
  family.make = [](const std::string& name,
                   const EngineOptions& options) -> std::unique_ptr<ProximityEngine> {
    if (name != "cuda_tree") {
      return nullptr;
    }
    return std::make_unique<CudaTreeEngine>(make_test_device(), options);
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
