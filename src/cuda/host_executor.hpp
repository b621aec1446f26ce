#pragma once

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "src/cuda/device.hpp"
#include "src/cuda/device_buffer.hpp"
#include "src/cuda/warp.hpp"
#include "src/query/threads.hpp"

namespace fiber {

/// No more than is needed: what is written beyond it is found.
struct HeapMemory {
  static std::size_t room_for(std::size_t count) { return count; }
  static void* allocate(std::size_t bytes) { return ::operator new(bytes); }
  static void release(void* data) { ::operator delete(data); }
};

/// Kernels as loops, on as many threads as the caller's arena has; DeviceTreeOf says what executors
/// have.
template <class Memory>
class HostExecutor {
 public:
  template <class T>
  using Buffer = DeviceBuffer<T, Memory>;
  template <class T>
  using HostBuffer = DeviceBuffer<T, Memory>;

  /// Few, so that small scenes have many parts.
  static constexpr std::uint32_t min_judged_at_once = 50;
  static constexpr std::uint64_t max_values = std::numeric_limits<std::uint32_t>::max();

  class Clock {
   public:
    void start(HostExecutor& /*executor*/) {
      stages_.clear();
      last_ = std::chrono::steady_clock::now();
    }
    void end(HostExecutor& /*executor*/, const char* stage) {
      const auto now = std::chrono::steady_clock::now();
      stages_.push_back({stage, std::chrono::duration<double>(now - last_).count()});
      last_ = now;
    }
    std::vector<DeviceStage> stages() const { return stages_; }

   private:
    std::vector<DeviceStage> stages_;
    std::chrono::steady_clock::time_point last_;
  };

  /// All is done when it is called for.
  struct Mark {
    void set(HostExecutor& /*executor*/) {}
    void wait() const {}
  };

  class Turn {
   public:
    explicit Turn(HostExecutor& executor) : executor_(executor) { ++executor_.turns_; }
    ~Turn() { --executor_.turns_; }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    HostExecutor& executor_;
  };

  template <class T>
  void upload(const T* from, std::size_t count, Buffer<T>& to) {
    assert(turns_ > 0);
    to.resize(count);
    std::copy(from, from + count, to.data());
  }
  template <class T>
  void upload_in_place(const T* from, std::size_t count, Buffer<T>& to) {
    upload(from, count, to);
  }

  template <class T>
  void download(const Buffer<T>& from, std::size_t first, std::size_t count, T* to) {
    download_from(from.data() + first, count, to);
  }
  template <class T>
  void download_from(const T* from, std::size_t count, T* to) {
    assert(turns_ > 0);
    std::copy(from, from + count, to);
  }

  template <class T>
  void send(const Buffer<T>& from, std::size_t first, std::size_t count, HostBuffer<T>& to) {
    std::copy(from.data() + first, from.data() + first + count, to.data() + first);
  }
  void wait_for_sent() {}

  std::shared_ptr<void> lock_pages(const void* data, std::size_t /*bytes*/) {
    return {const_cast<void*>(data), [](void*) {}};
  }

  std::optional<int> gpu() const { return std::nullopt; }
  std::size_t memory_bytes() const { return 0; }
  void require_own(const void* /*pointer*/) {}
  void wait_for_others() {}

  void add_up(Buffer<std::uint32_t>& values, std::size_t first, std::size_t count) {
    std::uint32_t* const from = values.data() + first;
    std::partial_sum(from, from + count, from);
  }

  template <class T>
  void zero(Buffer<T>& buffer) {
    std::fill(buffer.data(), buffer.data() + buffer.size(), T(0));
  }

  template <class Call>
  void for_each(std::uint32_t count, const Call& call) {
    assert(turns_ > 0);
    for_each_of(count, [&](std::size_t index) { call(static_cast<std::uint32_t>(index)); });
  }

  template <class Call>
  void for_each_warp(std::uint32_t count, const Call& call) {
    assert(turns_ > 0);
    for_each_of(count, [&](std::size_t index) {
      typename Call::Scratch scratch;
      call(HostWarp(), static_cast<std::uint32_t>(index), scratch);
    });
  }

  void sort_by_key(Buffer<std::uint32_t>& keys, Buffer<std::uint32_t>& values, std::size_t count,
                   int /*bits*/) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> both(count);
    for (std::size_t i = 0; i < count; ++i) {
      both[i] = {keys.data()[i], values.data()[i]};
    }
    std::stable_sort(both.begin(), both.end(),
                     [](const auto& x, const auto& y) { return x.first < y.first; });
    for (std::size_t i = 0; i < count; ++i) {
      keys.data()[i] = both[i].first;
      values.data()[i] = both[i].second;
    }
  }

  void sort(Buffer<std::uint64_t>& keys, std::size_t count, int /*bits*/) {
    std::sort(keys.data(), keys.data() + count);
  }

 private:
  std::atomic<int> turns_{0};  ///< what is done outside of one would go to others' GPU
};

}  // namespace fiber
