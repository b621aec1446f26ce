#pragma once

#include <cstdint>

#include "src/cuda/warp.hpp"

namespace fiber {

/// The lanes as threads of a GPU: HostWarp's counterpart.
class DeviceWarp {
 public:
  /// In a register of each thread.
  template <class T>
  class PerLane {
   public:
    __device__ T& operator[](int /*lane*/) { return value_; }
    __device__ const T& operator[](int /*lane*/) const { return value_; }

   private:
    T value_;
  };

  template <class Call>
  __device__ void each(const Call& call) const {
    call(lane());
  }

  template <class Predicate>
  __device__ std::uint32_t ballot(const Predicate& predicate) const {
    return __ballot_sync(all_lanes, predicate(lane()));
  }

  template <class T>
  __device__ T from(const PerLane<T>& values, int lane) const {
    return exchanged(values[0],
                     [=](std::uint32_t word) { return __shfl_sync(all_lanes, word, lane); });
  }

  template <class T, class Join>
  __device__ T reduce(const PerLane<T>& values, const Join& join) const {
    T all = values[0];
    for (int apart = warp_width / 2; apart > 0; apart /= 2) {
      join(all, exchanged(all, [=](std::uint32_t word) {
             return __shfl_xor_sync(all_lanes, word, apart);
           }));
    }
    return all;
  }

  __device__ std::uint64_t raise(std::uint64_t* counter, std::uint64_t by) const {
    unsigned long long before = 0;
    if (lane() == 0) {
      before = atomicAdd(reinterpret_cast<unsigned long long*>(counter), by);
    }
    return __shfl_sync(all_lanes, before, 0);
  }

  __device__ void sync() const { __syncwarp(); }

 private:
  static constexpr unsigned all_lanes = 0xFFFFFFFFU;

  __device__ static int lane() { return static_cast<int>(threadIdx.x % warp_width); }

  /// A value whose words come from other lanes.
  template <class T, class Exchange>
  __device__ static T exchanged(const T& value, const Exchange& exchange) {
    constexpr std::size_t count = sizeof(T) / sizeof(std::uint32_t);
    static_assert(count * sizeof(std::uint32_t) == sizeof(T), "values are whole words");
    std::uint32_t words[count];
    memcpy(words, &value, sizeof(T));
#pragma unroll
    for (std::uint32_t& word : words) {
      word = exchange(word);
    }
    T result;
    memcpy(&result, words, sizeof(T));
    return result;
  }
};

}  // namespace fiber
