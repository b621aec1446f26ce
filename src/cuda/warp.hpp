#pragma once

#include <cstdint>

#include "src/geometry/one_lane.hpp"

namespace fiber {

/// A kernel works on 32 lanes at a time, a warp. On a GPU these are threads (DeviceWarp), here they
/// are a loop: kernels are templates over the two. What differs from lane to lane stands in the
/// functions a kernel hands its warp; everything else is the same in all lanes.
constexpr int warp_width = 32;

/// A bit of a lane, and those of the lanes before it.
FIBER_ON_DEVICE inline std::uint32_t bit_of(int lane) { return std::uint32_t{1} << lane; }
FIBER_ON_DEVICE inline std::uint32_t bits_before(int lane) { return bit_of(lane) - 1U; }

FIBER_ON_DEVICE inline int count_bits(std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return __popc(bits);
#else
  return __builtin_popcount(bits);
#endif
}

/// The lowest bit that is set, of at least one.
FIBER_ON_DEVICE inline int lowest_bit(std::uint32_t bits) {
#ifdef __CUDA_ARCH__
  return __ffs(static_cast<int>(bits)) - 1;
#else
  return __builtin_ctz(bits);
#endif
}

/// The lanes as a loop.
class HostWarp {
 public:
  /// A value of each lane.
  template <class T>
  class PerLane {
   public:
    T& operator[](int lane) { return values_[lane]; }
    const T& operator[](int lane) const { return values_[lane]; }

   private:
    T values_[warp_width];
  };

  /// Calls with each lane.
  template <class Call>
  void each(const Call& call) const {
    for (int lane = 0; lane < warp_width; ++lane) {
      call(lane);
    }
  }

  /// The bits of those lanes that it is true for.
  template <class Predicate>
  std::uint32_t ballot(const Predicate& predicate) const {
    std::uint32_t bits = 0;
    for (int lane = 0; lane < warp_width; ++lane) {
      bits |= predicate(lane) ? bit_of(lane) : 0U;
    }
    return bits;
  }

  /// The value of one lane.
  template <class T>
  T from(const PerLane<T>& values, int lane) const {
    return values[lane];
  }

  /// One value of all, which may be put together in any order.
  /// @param join adds its second argument to its first
  template <class T, class Join>
  T reduce(const PerLane<T>& values, const Join& join) const {
    T all = values[0];
    for (int lane = 1; lane < warp_width; ++lane) {
      join(all, values[lane]);
    }
    return all;
  }

  /// Raises a counter that all warps share; what it was.
  std::uint64_t raise(std::uint64_t* counter, std::uint64_t by) const {
    return __atomic_fetch_add(counter, by, __ATOMIC_RELAXED);
  }

  /// Others read after it what lanes have written before.
  void sync() const {}
};

}  // namespace fiber
