#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <random>

namespace fiber {

// The arithmetic and the random numbers of the scenes, the same bits on every machine: from + − · /
// √ and floor alone, which IEEE 754 fixes, in an order that is written down, where libm's functions
// and Eigen's reductions fix neither.

/// A full turn [rad].
inline constexpr double tau = 6.283185307179586;

/// sin(2πx), with an error below 1e-13.
inline double sine_of_turns(double x) {
  double y = x - std::floor(x + 0.5);
  y = y > 0.25 ? 0.5 - y : y;
  y = y < -0.25 ? -0.5 - y : y;
  const double angle = tau * y;  // within ±π/2
  const double square = angle * angle;
  // The Taylor series, whose first term left out is (π/2)¹⁹ / 19! = 4e-14.
  double sum = 0.0;
  for (int n = 16; n >= 2; n -= 2) {
    sum = (1.0 - sum) * square / (n * (n + 1));
  }
  return angle * (1.0 - sum);
}

/// cos(2πx), with an error below 1e-13.
inline double cosine_of_turns(double x) { return sine_of_turns(x + 0.25); }

/// The cube root of a number from 1e-18 to 1e18, with an error of a few units in the last place.
inline double cube_root(double x) {
  // Newton's method: a third closer with each step, then twice the digits.
  double root = x > 1.0 ? x : 1.0;
  for (int step = 0; step < 120; ++step) {
    root -= (root - x / (root * root)) / 3.0;
  }
  return root;
}

/// From 0 to 1 while x does, level at both ends; 0 below and 1 above.
inline double smooth_step(double x) {
  const double y = x < 0.0 ? 0.0 : (x > 1.0 ? 1.0 : x);
  return y * y * (3.0 - 2.0 * y);
}

inline double dot(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

/// The vector with length 1. It must not be zero.
inline Eigen::Vector3d unit(const Eigen::Vector3d& v) { return v / std::sqrt(dot(v, v)); }

/// The part of v that is perpendicular to a unit vector, made a unit vector itself.
inline Eigen::Vector3d perpendicular_unit(const Eigen::Vector3d& v, const Eigen::Vector3d& axis) {
  return unit(v - dot(v, axis) * axis);
}

/// A bijection in which each bit depends on all: the last step of SplitMix64.
inline std::uint64_t mixed(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30U)) * 0xbf58'476d'1ce4'e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d0'49bb'1331'11ebU;
  return bits ^ (bits >> 31U);
}

/// Seed of the random numbers that one of many has for itself; no two of a scene have the same.
inline std::uint64_t stream_seed(std::uint64_t seed, std::uint64_t number) {
  return mixed(mixed(seed + 0x9e37'79b9'7f4a'7c15U) + number);
}

/// Random numbers; the standard fixes std::mt19937_64, but not its distributions.
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
      const double squared = dot(point, point);
      if (squared > 0x1p-20 && squared <= 1.0) {
        return point / std::sqrt(squared);
      }
    }
  }

 private:
  std::mt19937_64 generator_;
};

}  // namespace fiber
