#include "src/paper/bounds/direction_set.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "test/support/error_of.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Lines = std::vector<Vector3d>;

constexpr double pi = 3.14159265358979323846;
constexpr int fewest_lines = 3;
constexpr int max_lines = 100;

/// [degrees] smallest angles of the best packings known, from three lines on (Conway, Hardin and
/// Sloane 1996).
constexpr double best_known[] = {90.0,    70.5288, 63.4349, 63.4349, 54.7356, 49.6399, 47.9821,
                                 46.6746, 44.4031, 41.8820, 39.8131, 38.6824, 38.1349, 37.3774};

/// [rad] the smallest angle between any two lines along these unit vectors, at most π/2; π/2 if
/// there are fewer than two.
double smallest_angle(const Lines& directions) {
  double smallest = pi / 2.0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double sine = directions[i].cross(directions[j]).norm();
      const double cosine = std::abs(directions[i].dot(directions[j]));
      smallest = std::min(smallest, std::atan2(sine, cosine));
    }
  }
  return smallest;
}

/// [rad] What no 2N points on a sphere can exceed (Fejes Tóth 1943), so no N lines either.
double upper_bound(int lines) {
  const double points = 2.0 * lines;
  const double omega = points / (points - 2.0) * pi / 6.0;
  const double cotangent = 1.0 / std::tan(omega);
  return std::acos(0.5 * (cotangent * cotangent - 1.0));
}

TEST(DirectionSetTest, ReachesTheBestKnownAngles) {
  int lines = fewest_lines;
  for (const double angle : best_known) {
    EXPECT_NEAR(smallest_angle(grassmannian_directions(2 * lines)) * 180.0 / pi, angle, 1e-3)
        << lines << " lines";
    ++lines;
  }
}

TEST(DirectionSetTest, HasAllSetsOfUnitVectors) {
  for (int n = fewest_lines; n <= max_lines; ++n) {
    const Lines& set = grassmannian_directions(2 * n);
    ASSERT_EQ(set.size(), static_cast<std::size_t>(n));
    for (const Vector3d& direction : set) {
      EXPECT_NEAR(direction.norm(), 1.0, 1e-15) << n << " lines";
    }
  }
}

TEST(DirectionSetTest, StaysBelowThePointBoundAndCloseToIt) {
  for (int n = fewest_lines; n <= max_lines; ++n) {
    const double angle = smallest_angle(grassmannian_directions(2 * n));
    EXPECT_LE(angle, upper_bound(n) + 1e-9) << n << " lines";
    EXPECT_GE(angle, 0.9 * upper_bound(n)) << n << " lines";
  }
}

TEST(DirectionSetTest, AngleNeverGrowsWithTheNumberOfLines) {
  constexpr double rounding = 1e-9;
  for (int n = fewest_lines; n < max_lines; ++n) {
    EXPECT_GE(smallest_angle(grassmannian_directions(2 * n)) + rounding,
              smallest_angle(grassmannian_directions(2 * n + 2)))
        << n << " and " << n + 1 << " lines";
  }
}

TEST(DirectionSetTest, StaysAwayFromTheCoordinateAxes) {
  constexpr double min_angle = 0.05;  // [rad]
  for (int n = fewest_lines; n <= max_lines; ++n) {
    for (const Vector3d& direction : grassmannian_directions(2 * n)) {
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_GT(smallest_angle({direction, Vector3d::Unit(axis)}), min_angle) << n << " lines";
      }
    }
  }
}

TEST(DirectionSetTest, ThreeLinesAreATurnedFrame) {
  const Lines& set = grassmannian_directions(6);
  EXPECT_NEAR(std::abs(set[0].cross(set[1]).dot(set[2])), 1.0, 1e-9);
}

TEST(DirectionSetTest, RejectsOtherNumbersOfSlabs) {
  for (const int k : {-6, 0, 4, 5, 7, 199, 201, 202, std::numeric_limits<int>::min(),
                      std::numeric_limits<int>::max()}) {
    EXPECT_THROW(grassmannian_directions(k), std::invalid_argument) << k;
  }
  EXPECT_EQ(error_of([] { grassmannian_directions(7); }),
            "k-DOP with k = 7: k must be even, from 6 to 200");
}

TEST(DirectionSetTest, ClassicSetsAreTheDirectionsOfTheCube) {
  using Kinds = std::set<int>;  // how many coordinates differ from zero
  const std::vector<std::pair<int, Kinds>> expected = {
      {6, {1}}, {14, {1, 3}}, {18, {1, 2}}, {26, {1, 2, 3}}};
  for (const auto& [k, kinds] : expected) {
    const Lines& set = classic_directions(k);
    EXPECT_EQ(set.size(), static_cast<std::size_t>(k / 2));
    EXPECT_GT(smallest_angle(set), 0.1) << k << " has a line twice";
    for (const Vector3d& direction : set) {
      EXPECT_NEAR(direction.norm(), 1.0, 1e-15);
      const Eigen::Array3d magnitudes = direction.array().abs();
      const double largest = magnitudes.maxCoeff();
      EXPECT_TRUE(((magnitudes == 0.0) || (magnitudes == largest)).all()) << direction.transpose();
      EXPECT_EQ(kinds.count(static_cast<int>((magnitudes > 0.0).count())), 1U) << k;
    }
  }
}

TEST(DirectionSetTest, RejectsOtherClassicSets) {
  for (const int k : {-14, 0, 8, 13, 16, 20, 28}) {
    EXPECT_THROW(classic_directions(k), std::invalid_argument) << k;
  }
  EXPECT_EQ(error_of([] { classic_directions(16); }),
            "classic k-DOP with k = 16: k must be 6, 14, 18 or 26");
}

TEST(DirectionSetTest, SmallestAngleIsThatBetweenLines) {
  EXPECT_DOUBLE_EQ(smallest_angle({}), pi / 2);
  EXPECT_DOUBLE_EQ(smallest_angle({Vector3d::UnitX()}), pi / 2);
  EXPECT_EQ(smallest_angle({Vector3d::UnitX(), -Vector3d::UnitX()}), 0.0);
  EXPECT_DOUBLE_EQ(smallest_angle({Vector3d::UnitX(), Vector3d::UnitY(),
                                   Vector3d(-1.0, 1e-9, 0.0).normalized()}),
                   1e-9);
}

}  // namespace
}  // namespace fiber::test
