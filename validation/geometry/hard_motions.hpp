#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/scenes/portable_math.hpp"

namespace fiber {

/// Two capsules that move: the two ends of each axis, before and after [m].
struct HardMotion {
  std::array<Eigen::Vector3d, 2> a_before;
  std::array<Eigen::Vector3d, 2> a_after;
  std::array<Eigen::Vector3d, 2> b_before;
  std::array<Eigen::Vector3d, 2> b_after;
  double radius_a = 0.0;  ///< [m]
  double radius_b = 0.0;  ///< [m]

  /// As contact_time() takes it; refers to this motion.
  SegmentMotions motions() const {
    return {a_before.data(),
            a_after.data(),
            b_before.data(),
            b_after.data(),
            {radius_a, radius_b, 0.0}};
  }
};

/// Motions that are hard in the same way, for tests and benchmarks of accuracy.
struct MotionFamily {
  std::string name;
  std::function<HardMotion(Random&)> make;
};

/// All families: random motions, at scales from 1e-310 to 1e140 m and far from the origin; parallel
/// segments and such that stay so, nearly parallel and coincident ones, segments without length,
/// without motion, with ends that change places; motions of 10⁶ lengths; segments that only graze
/// each other, touch at the beginning or at the end, slide along each other at the distance of
/// contact; ones without thickness that cross, or do so but for a rounding.
const std::vector<MotionFamily>& motion_families();

/// Motions of a family: the same bits on every machine.
std::vector<HardMotion> hard_motions(const MotionFamily& family, std::uint32_t count,
                                     std::uint64_t seed);

}  // namespace fiber
