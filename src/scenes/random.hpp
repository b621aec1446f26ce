#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <random>

namespace fiber {

/// Random numbers that are the same bits on every machine: the standard fixes std::mt19937_64, but
/// not its distributions, and IEEE 754 fixes + − · / and √, but not the functions of libm.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  /// In [lower, upper).
  double uniform(double lower, double upper) {
    const double unit = static_cast<double>(generator_() >> 11U) * 0x1p-53;
    return lower + unit * (upper - lower);
  }

  /// Each coordinate in [lower, upper).
  Eigen::Vector3d point_in_cube(double lower, double upper) {
    // One statement each: the order in which a function's arguments are evaluated is not fixed.
    const double x = uniform(lower, upper);
    const double y = uniform(lower, upper);
    const double z = uniform(lower, upper);
    return {x, y, z};
  }

  /// Uniform on the unit sphere.
  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d point = point_in_cube(-1.0, 1.0);
      const double squared = squared_length(point);
      if (squared > 0x1p-20 && squared <= 1.0) {
        return point / std::sqrt(squared);
      }
    }
  }

  /// In this order of summation, whatever Eigen's may be.
  static double squared_length(const Eigen::Vector3d& v) {
    return v.x() * v.x() + v.y() * v.y() + v.z() * v.z();
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace fiber
