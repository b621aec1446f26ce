#pragma once

#include <cstdint>
#include <limits>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Pairs as keys, in the order of the contacts.
inline std::uint64_t pair_key(PointPair pair) { return std::uint64_t{pair.a} << 32U | pair.b; }
inline PointPair pair_of(std::uint64_t key) {
  return {static_cast<std::uint32_t>(key >> 32U), static_cast<std::uint32_t>(key)};
}

/// Which pairs of segments matter (any more).
struct PairBound {
  /// No pair has such a key.
  static constexpr std::uint64_t no_key = std::numeric_limits<std::uint64_t>::max();

  /// [m] Those whose gap is at most this; less than 0 where only deeper penetration matters.
  float gap = 0.0F;

  /// Only smaller keys count at that distance: where no pair can be closer, but many are as close.
  std::uint64_t key = no_key;
};

}  // namespace fiber
