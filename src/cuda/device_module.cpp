// The GPU's side of the engine is a library of its own that is loaded where it is installed: what
// has no GPU needs nothing of CUDA's.

#include <dlfcn.h>

#include <stdexcept>
#include <string>

#include "src/cuda/device.hpp"

namespace fiber {
namespace {

struct DeviceModule {
  Device* (*make_device)() = nullptr;
  std::string problem;  // why there is none
};

/// Beside this library, and nowhere else: another one of that name may be of another version.
std::string path_of_module() {
  Dl_info here;
  if (dladdr(reinterpret_cast<const void*>(&missing_cuda), &here) == 0) {
    return FIBER_PROXIMITY_DEVICE_MODULE;
  }
  const std::string path = here.dli_fname;
  const std::size_t slash = path.rfind('/');
  return (slash == std::string::npos ? "./" : path.substr(0, slash + 1)) +
         FIBER_PROXIMITY_DEVICE_MODULE;
}

DeviceModule load() {
  DeviceModule loaded;
  void* const library = dlopen(path_of_module().c_str(), RTLD_NOW | RTLD_LOCAL);
  void* const symbol =
      library != nullptr ? dlsym(library, "fiber_proximity_make_cuda_device") : nullptr;
  if (symbol == nullptr) {
    loaded.problem = std::string("it needs " FIBER_PROXIMITY_DEVICE_MODULE
                                 ", which is built where CUDA's compiler is, and in the Debian "
                                 "package libfiber-proximity-cuda: ") +
                     dlerror();
    return loaded;
  }
  loaded.make_device = reinterpret_cast<Device* (*)()>(symbol);
  return loaded;
}

/// Loaded once, and for as long as the process runs.
const DeviceModule& device_module() {
  static const DeviceModule loaded = load();
  return loaded;
}

}  // namespace

const std::string& missing_cuda() { return device_module().problem; }

std::unique_ptr<Device> make_cuda_device() {
  if (!missing_cuda().empty()) {
    throw std::runtime_error("cuda_tree: " + missing_cuda());
  }
  return std::unique_ptr<Device>(device_module().make_device());
}

}  // namespace fiber
