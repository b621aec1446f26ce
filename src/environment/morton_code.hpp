#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace fiber {

/// Bits of a cell's index along each axis; as many levels of an octree.
constexpr int morton_levels = 16;

/// Every third bit of these becomes one of 16 bits in a row.
inline std::uint32_t every_third_bit(std::uint64_t code) {
  std::uint64_t x = code & 0x1249249249249249U;
  x = (x | x >> 2U) & 0x10c30c30c30c30c3U;
  x = (x | x >> 4U) & 0x100f00f00f00f00fU;
  x = (x | x >> 8U) & 0x001f0000ff0000ffU;
  x = (x | x >> 16U) & 0x001f00000000ffffU;
  return static_cast<std::uint32_t>(x & 0xffffU);
}

/// The other way round.
inline std::uint64_t two_zeros_between_bits(std::uint32_t bits) {
  std::uint64_t x = bits & 0xffffU;
  x = (x | x << 16U) & 0x001f0000ff0000ffU;
  x = (x | x << 8U) & 0x100f00f00f00f00fU;
  x = (x | x << 4U) & 0x10c30c30c30c30c3U;
  x = (x | x << 2U) & 0x1249249249249249U;
  return x;
}

/// A cell's place on Morton's curve, from its index along each axis, 0 to 65535: three bits per
/// level, the coarsest first, so that what is in one cube of the octree is in a row.
inline std::uint64_t morton_code(const Eigen::Array3i& cell) {
  const auto bits = [&](int axis) {
    return two_zeros_between_bits(static_cast<std::uint32_t>(cell[axis]));
  };
  return bits(0) | bits(1) << 1U | bits(2) << 2U;
}

/// The index along each axis again.
inline Eigen::Array3i morton_cell(std::uint64_t code) {
  const auto index = [&](unsigned axis) { return static_cast<int>(every_third_bit(code >> axis)); };
  return {index(0), index(1), index(2)};
}

/// Which of eight children of a cube on this level (0 for the largest) holds a cell: bit 0 where it
/// is the upper half along x, bit 1 along y, bit 2 along z.
inline unsigned morton_child(std::uint64_t code, int level) {
  return static_cast<unsigned>(code >> (3 * (morton_levels - 1 - level))) & 7U;
}

}  // namespace fiber
