#include <memory>

#include "src/cuda/device_of.hpp"
#include "src/cuda/host_executor.hpp"

namespace fiber {

std::unique_ptr<Device> make_host_device() {
  using Executor = HostExecutor<HeapMemory>;
  return std::make_unique<DeviceOf<Executor>>(std::make_shared<Executor>());
}

}  // namespace fiber
