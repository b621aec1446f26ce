#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "src/scenes/portable_math.hpp"

namespace fiber {

/// Two capsules that touch, give or take four units in the last place of the sum of their radii.
struct HardPair {
  Eigen::Vector3d p0, p1;  ///< ends of the first segment [m]
  Eigen::Vector3d q0, q1;  ///< ends of the second [m]
  double radius_a = 0.0;   ///< [m]
  double radius_b = 0.0;   ///< [m]
};

/// Pairs of segments that are hard in the same way, for tests and benchmarks of accuracy.
struct HardFamily {
  std::string name;
  std::function<HardPair(Random&)> make;  ///< the segments; radii are chosen by hard_pairs()
};

/// All families: generic pairs at scales from 1e-300 to 1e149 m and denormal ones; lines at angles
/// from 1e-1 to 1e-16, of metres and millimetres, with gaps from 0 to 0.1 of the length; parallel,
/// collinear, zero-length, identical and reversed segments, lengths of very different size,
/// millimetres far from the origin; shared ends, crossings, ends on the other's inside.
const std::vector<HardFamily>& hard_families();

/// Pairs of a family: the same bits on every machine.
std::vector<HardPair> hard_pairs(const HardFamily& family, std::uint32_t count, std::uint64_t seed);

}  // namespace fiber
