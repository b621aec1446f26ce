#pragma once

#include <cstdint>

namespace fiber {

/// Two segments by the indices of their first points: within one assembly the smaller one first,
/// or one of a shape and one of the fibres.
struct PointPair {
  std::uint32_t a;
  std::uint32_t b;
};

}  // namespace fiber
