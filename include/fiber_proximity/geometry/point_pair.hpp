#pragma once

#include <cstdint>

namespace fiber {

/// Two segments by the indices of their first points: within one assembly the smaller one first,
/// or one of a shape and one of the fibres.
struct PointPair {
  std::uint32_t a;
  std::uint32_t b;
};

/// Segments that follow each other, by the indices of their first points: begin … end - 1.
struct PointRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

}  // namespace fiber
