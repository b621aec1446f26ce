#pragma once

#include <cstdint>

#include "src/cuda/warp.hpp"

namespace fiber {

/// Writes pairs down as they are found.
struct WritePairs {
  std::uint64_t* pairs;  ///< room for their keys
  std::uint64_t capacity;
  std::uint64_t* count;  ///< of all that were found, also of those there was no room for

  /// Whether no more is wanted of these candidates.
  template <class Warp>
  FIBER_ON_DEVICE bool is_over(Warp /*warp*/, std::uint32_t /*first*/,
                               std::uint32_t /*last*/) const {
    return false;
  }

  /// @param lanes that have a pair
  /// @param key of the pair of a lane, the smaller first point in its upper half
  template <class Warp, class Key>
  FIBER_ON_DEVICE void take(Warp warp, std::uint32_t lanes, const Key& key) const {
    const std::uint64_t at = warp.raise(count, static_cast<std::uint64_t>(count_bits(lanes)));
    warp.each([&](int lane) {
      const std::uint64_t to =
          at + static_cast<std::uint64_t>(count_bits(lanes & bits_before(lane)));
      if ((lanes & bit_of(lane)) != 0 && to < capacity) {
        pairs[to] = key(lane);
      }
    });
  }
};

}  // namespace fiber
