#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>
#include <vector>

#include "test/support/rounds.hpp"

namespace fiber::test {

constexpr std::uint64_t fixed_seed = 1;

/// Seed of this run: FIBER_PROXIMITY_TEST_SEED, or always the same one, so that the suite answers
/// alike for everyone; scripts/campaign.sh tries others. Throws std::invalid_argument.
inline std::uint64_t run_seed() {
  static const std::uint64_t seed = [] {
    const char* given = std::getenv("FIBER_PROXIMITY_TEST_SEED");
    std::uint64_t number = fixed_seed;
    if (given != nullptr) {
      const char* const end = given + std::strlen(given);
      const auto [stop, error] = std::from_chars(given, end, number);
      if (error != std::errc() || stop != end) {
        throw std::invalid_argument("FIBER_PROXIMITY_TEST_SEED: a whole number below 2^64, not '" +
                                    std::string(given) + "'");
      }
    }
    return number;
  }();
  // By this property the campaign knows which tests draw.
  testing::Test::RecordProperty("drawn_with_seed", std::to_string(seed));
  return seed;
}

/// That a test has seen enough of what it is about is a fact about the numbers of the fixed seed in
/// all rounds. With others, or in fewer of them, chance decides: nothing is expected then.
template <class Count>
void expect_enough(Count seen, Count least) {
  if (run_seed() == fixed_seed && rounds_less == 1) {
    EXPECT_GE(seen, least) << "too few to tell anything";
  }
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

/// A source of random numbers: the same ones for the same seed and stream. An expectation about
/// what is drawn must hold for every seed.
class Random {
 public:
  explicit Random(std::uint64_t stream = 0) : Random(run_seed(), stream) {}
  Random(std::uint64_t seed, std::uint64_t stream) : engine_(seed + 0x9E3779B97F4A7C15U * stream) {}

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
  Eigen::Quaterniond rotation() {
    for (;;) {
      const Eigen::Vector3d v = in_cube();
      const Eigen::Quaterniond q(uniform(-1.0, 1.0), v.x(), v.y(), v.z());
      if (q.squaredNorm() > 0.01 && q.squaredNorm() < 1.0) {
        return q.normalized();
      }
    }
  }

 private:
  std::mt19937_64 engine_;
};

/// What to test with of all: all, or every few from a random one on where tests go fewer rounds; at
/// least one of those there are.
template <class Element>
std::vector<Element> sampled(const std::vector<Element>& all, Random& random) {
  std::vector<Element> some;
  const int last_first = std::clamp(static_cast<int>(all.size()), 1, rounds_less) - 1;
  for (auto i = static_cast<std::size_t>(random.integer(0, last_first)); i < all.size();
       i += rounds_less) {
    some.push_back(all[i]);
  }
  return some;
}

}  // namespace fiber::test
