#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <random>
#include <string>

namespace fiber::test {

/// Seed of this run: FIBER_PROXIMITY_TEST_SEED, or a fresh one. Print it with every failure
/// (SCOPED_TRACE(seed_message(seed))), and a failure can be repeated.
inline std::uint64_t run_seed() {
  static const std::uint64_t seed = [] {
    const char* given = std::getenv("FIBER_PROXIMITY_TEST_SEED");
    return given != nullptr ? std::strtoull(given, nullptr, 10) : std::random_device{}();
  }();
  return seed;
}

inline std::string seed_message() {
  return "repeat with FIBER_PROXIMITY_TEST_SEED=" + std::to_string(run_seed());
}

/// A name as gtest takes it: letters, digits and underscores.
inline std::string test_name(std::string name) {
  for (char& c : name) {
    c = std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return name;
}

/// A source of random numbers that differs from test to test and, unless fixed, run to run.
class Random {
 public:
  explicit Random(std::uint64_t stream = 0) : engine_(run_seed() + 0x9E3779B97F4A7C15U * stream) {}

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }
  int integer(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }
  bool chance(double probability) { return uniform(0.0, 1.0) < probability; }

  Eigen::Vector3d in_cube(double half_edge = 1.0) {
    const double x = uniform(-half_edge, half_edge);
    const double y = uniform(-half_edge, half_edge);
    return {x, y, uniform(-half_edge, half_edge)};
  }
  Eigen::Vector3d direction() {
    for (;;) {
      const Eigen::Vector3d v = in_cube();
      if (v.squaredNorm() > 0.01 && v.squaredNorm() < 1.0) {
        return v.normalized();
      }
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace fiber::test
