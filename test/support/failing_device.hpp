#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "src/cuda/device_of.hpp"
#include "src/cuda/host_executor.hpp"

namespace fiber::test {

/// When devices fail, and what they hold: memory knows no device that it is of.
struct Fault {
  int calls_before = 0;  // the one after these fails
  bool is_for_good = false;
  int calls = 0;
  bool has_failed = false;
  std::atomic<int> buffers{0};
};
inline Fault fault;

inline constexpr const char* lost_error =
    "cuda_tree: the GPU has failed: an illegal memory access was encountered "
    "(cudaErrorIllegalAddress); this process cannot use it any more";

inline void device_call() {
  const bool fails = (fault.has_failed && fault.is_for_good) ||
                     (!fault.has_failed && fault.calls == fault.calls_before);
  ++fault.calls;
  if (fails) {
    fault.has_failed = true;
    throw std::runtime_error(lost_error);
  }
}

/// @param calls_before the call after so many fails, and for good all after it
inline void will_fail(int calls_before, bool is_for_good) {
  fault.calls_before = calls_before;
  fault.is_for_good = is_for_good;
  fault.calls = 0;
  fault.has_failed = false;
}
inline void will_not_fail() { will_fail(-1, false); }

struct FailingMemory {
  static std::size_t room_for(std::size_t count) { return count; }
  static void* allocate(std::size_t bytes) {
    device_call();
    ++fault.buffers;
    return HeapMemory::allocate(bytes);
  }
  static void release(void* data) {
    fault.buffers -= data != nullptr ? 1 : 0;
    HeapMemory::release(data);
  }
};

/// Fails in whatever can fail on a GPU.
class FailingExecutor : public HostExecutor<FailingMemory> {
 public:
  using Host = HostExecutor<FailingMemory>;

  struct Clock {
    void start(FailingExecutor& /*executor*/) { device_call(); }
    void end(FailingExecutor& /*executor*/, const char* /*stage*/) { device_call(); }
    std::vector<DeviceStage> stages() const {
      device_call();
      return {};
    }
  };
  struct Mark {
    void set(FailingExecutor& /*executor*/) { device_call(); }
    void wait() const { device_call(); }
  };

  template <class... Arguments>
  void upload(Arguments&&... arguments) {
    device_call();
    Host::upload(arguments...);
  }
  template <class... Arguments>
  void upload_in_place(Arguments&&... arguments) {
    device_call();
    Host::upload_in_place(arguments...);
  }
  template <class... Arguments>
  void download(Arguments&&... arguments) {
    device_call();
    Host::download(arguments...);
  }
  template <class... Arguments>
  void download_from(Arguments&&... arguments) {
    device_call();
    Host::download_from(arguments...);
  }
  template <class... Arguments>
  void send(Arguments&&... arguments) {
    device_call();
    Host::send(arguments...);
  }
  void wait_for_sent() { device_call(); }
  std::shared_ptr<void> lock_pages(const void* data, std::size_t bytes) {
    device_call();
    return Host::lock_pages(data, bytes);
  }
  std::optional<int> gpu() const { return std::nullopt; }
  void require_own(const void* /*pointer*/) { device_call(); }
  void wait_for_others() { device_call(); }
  template <class... Arguments>
  void add_up(Arguments&&... arguments) {
    device_call();
    Host::add_up(arguments...);
  }
  template <class T>
  void zero(Buffer<T>& buffer) {
    device_call();
    Host::zero(buffer);
  }
  template <class Call>
  void for_each(std::uint32_t count, const Call& each) {
    device_call();
    Host::for_each(count, each);
  }
  template <class Call>
  void for_each_warp(std::uint32_t count, const Call& each) {
    device_call();
    Host::for_each_warp(count, each);
  }
  template <class... Arguments>
  void sort_by_key(Arguments&&... arguments) {
    device_call();
    Host::sort_by_key(arguments...);
  }
  template <class... Arguments>
  void sort(Arguments&&... arguments) {
    device_call();
    Host::sort(arguments...);
  }
};

inline std::unique_ptr<Device> make_failing_device() {
  return std::make_unique<DeviceOf<FailingExecutor>>(std::make_shared<FailingExecutor>());
}

}  // namespace fiber::test
