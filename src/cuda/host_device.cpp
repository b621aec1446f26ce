#include <algorithm>
#include <numeric>
#include <utility>

#include "src/cuda/device_of.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

/// Kernels as loops, on as many threads as the caller's arena has.
class HostExecutor {
 public:
  template <class T>
  class Buffer {
   public:
    void resize(std::size_t count) { values_.resize(count); }
    T* data() { return values_.data(); }
    const T* data() const { return values_.data(); }
    std::size_t size() const { return values_.size(); }
    std::size_t bytes() const { return values_.capacity() * sizeof(T); }

   private:
    std::vector<T> values_;
  };

  /// There is no device whose time would count.
  struct Clock {
    void start(HostExecutor& /*executor*/) {}
    void stop(HostExecutor& /*executor*/) {}
    double seconds() const { return 0.0; }
  };

  template <class T>
  void upload(const T* from, std::size_t count, Buffer<T>& to) {
    to.resize(count);
    std::copy(from, from + count, to.data());
  }

  template <class T>
  void download(const Buffer<T>& from, std::size_t first, std::size_t count, T* to) {
    download_from(from.data() + first, count, to);
  }
  template <class T>
  void download_from(const T* from, std::size_t count, T* to) {
    std::copy(from, from + count, to);
  }

  void require_own(const void* /*pointer*/) {}
  void wait_for_others() {}

  void add_up(Buffer<std::uint32_t>& values, std::size_t count) {
    std::partial_sum(values.data(), values.data() + count, values.data());
  }

  template <class T>
  void zero(Buffer<T>& buffer) {
    std::fill(buffer.data(), buffer.data() + buffer.size(), T(0));
  }

  template <class Call>
  void for_each(std::uint32_t count, const Call& call) {
    for_each_of(count, [&](std::size_t index) { call(static_cast<std::uint32_t>(index)); });
  }

  template <class Call>
  void for_each_warp(std::uint32_t count, const Call& call) {
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
};

}  // namespace

std::unique_ptr<Device> make_host_device() {
  return std::make_unique<DeviceOf<HostExecutor>>(std::make_shared<HostExecutor>());
}

}  // namespace fiber
