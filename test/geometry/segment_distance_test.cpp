#include "fiber_proximity/geometry/segment_distance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "test/support/exact_distance.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

struct Pair {
  Vector3d p0, p1, q0, q1;

  double largest_difference() const {
    return std::max({(p1 - p0).cwiseAbs().maxCoeff(), (q1 - q0).cwiseAbs().maxCoeff(),
                     (p0 - q0).cwiseAbs().maxCoeff(), (p1 - q0).cwiseAbs().maxCoeff(),
                     (p0 - q1).cwiseAbs().maxCoeff()});
  }
  Pair transformed(double scale, const Vector3d& shift) const {
    return {scale * p0 + shift, scale * p1 + shift, scale * q0 + shift, scale * q1 + shift};
  }
};

Pair random_pair(Random& random) {
  return {random.in_cube(), random.in_cube(), random.in_cube(), random.in_cube()};
}

/// Two crossing segments at this angle, this far apart.
Pair crossing(Random& random, double angle, double gap) {
  const Vector3d u = random.direction();
  const Vector3d side = u.cross(random.direction()).normalized();
  const Vector3d v = std::cos(angle) * u + std::sin(angle) * side;
  const Vector3d offset = gap * u.cross(side);
  const double a = random.uniform(-1.2, 0.2);
  const double b = random.uniform(-1.2, 0.2);
  const Vector3d centre = random.in_cube();
  return {centre + a * u, centre + (a + 1.0) * u, centre + offset + b * v,
          centre + offset + (b + 1.0) * v};
}

struct Family {
  const char* name;
  Pair (*make)(Random&);
};

const Family families[] = {
    {"generic", [](Random& r) { return random_pair(r); }},
    {"millimetres", [](Random& r) { return random_pair(r).transformed(1e-3, Vector3d::Zero()); }},
    {"angle_1e-5", [](Random& r) { return crossing(r, 1e-5, r.uniform(0.0, 1e-5)); }},
    {"angle_1e-7", [](Random& r) { return crossing(r, 1e-7, r.uniform(0.0, 1e-7)); }},
    {"angle_1e-9", [](Random& r) { return crossing(r, 1e-9, r.uniform(0.0, 1e-9)); }},
    {"angle_1e-12", [](Random& r) { return crossing(r, 1e-12, 0.0); }},
    {"angle_1e-16", [](Random& r) { return crossing(r, 1e-16, 0.1); }},
    {"parallel",
     [](Random& r) {
       Pair pair = random_pair(r);
       pair.q1 = pair.q0 + r.uniform(-2.0, 2.0) * (pair.p1 - pair.p0);
       return pair;
     }},
    {"collinear",
     [](Random& r) {
       const Vector3d p = r.in_cube();
       const Vector3d u = r.direction();
       return Pair{p, p + u, p + r.uniform(-2, 2) * u, p + r.uniform(-2, 2) * u};
     }},
    {"one_zero_length",
     [](Random& r) {
       Pair pair = random_pair(r);
       pair.q1 = pair.q0;
       return pair;
     }},
    {"both_zero_length",
     [](Random& r) {
       Pair pair = random_pair(r);
       pair.q1 = pair.q0;
       pair.p1 = pair.p0;
       return pair;
     }},
    {"identical",
     [](Random& r) {
       const Pair pair = random_pair(r);
       return Pair{pair.p0, pair.p1, pair.p0, pair.p1};
     }},
    {"reversed",
     [](Random& r) {
       const Pair pair = random_pair(r);
       return Pair{pair.p0, pair.p1, pair.p1, pair.p0};
     }},
    {"shared_end",
     [](Random& r) {
       Pair pair = random_pair(r);
       pair.q0 = pair.p1;
       return pair;
     }},
    {"length_ratio_1e8",
     [](Random& r) {
       Pair pair = random_pair(r);
       pair.q1 = pair.q0 + 1e-8 * r.direction();
       return pair;
     }},
    {"millimetres_at_1e6",
     [](Random& r) { return random_pair(r).transformed(1e-3, 1e6 * r.direction()); }},
    {"millimetres_at_1e8",
     [](Random& r) { return random_pair(r).transformed(1e-3, 1e8 * r.direction()); }},
    {"x1e-20", [](Random& r) { return random_pair(r).transformed(1e-20, Vector3d::Zero()); }},
    {"x1e-80", [](Random& r) { return random_pair(r).transformed(1e-80, Vector3d::Zero()); }},
    {"x1e-300", [](Random& r) { return random_pair(r).transformed(1e-300, Vector3d::Zero()); }},
    {"x1e80", [](Random& r) { return random_pair(r).transformed(1e80, Vector3d::Zero()); }},
    {"x1e149", [](Random& r) { return random_pair(r).transformed(1e149, Vector3d::Zero()); }},
    {"x1e-80_parallel",
     [](Random& r) { return crossing(r, 1e-9, 1e-9).transformed(1e-80, Vector3d::Zero()); }},
};

SegmentDistance distance(const Pair& pair) {
  return segment_distance(pair.p0, pair.p1, pair.q0, pair.q1);
}

class SegmentDistanceFamily : public testing::TestWithParam<Family> {};

TEST_P(SegmentDistanceFamily, IsTheExactOneWithinFourRoundings) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  for (int i = 0; i < 300; ++i) {
    const Pair pair = GetParam().make(random);
    const SegmentDistance found = distance(pair);
    const Wide signed_error =
        Wide(found.distance) - exact_distance(pair.p0, pair.p1, pair.q0, pair.q1);
    const Wide error = signed_error < 0 ? Wide(-signed_error) : signed_error;
    ASSERT_LE(error, Wide(4 * epsilon) * Wide(pair.largest_difference()) +
                         Wide(std::numeric_limits<double>::denorm_min()))
        << "pair " << i;
  }
}

TEST_P(SegmentDistanceFamily, ParametersPointsAndDistanceAgree) {
  SCOPED_TRACE(seed_message());
  Random random;
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  for (int i = 0; i < 300; ++i) {
    const Pair pair = GetParam().make(random);
    const SegmentDistance found = distance(pair);
    ASSERT_TRUE(found.s >= 0.0 && found.s <= 1.0 && found.t >= 0.0 && found.t <= 1.0);
    const Vector3d delta =
        (pair.q0 - pair.p0) + found.t * (pair.q1 - pair.q0) - found.s * (pair.p1 - pair.p0);
    const double tolerance =
        8 * epsilon * pair.largest_difference() + 4 * std::numeric_limits<double>::denorm_min();
    ASSERT_LE((delta - found.delta).cwiseAbs().maxCoeff(), tolerance) << "pair " << i;
    ASSERT_NEAR(found.delta.stableNorm(), found.distance, tolerance) << "pair " << i;
  }
}

TEST_P(SegmentDistanceFamily, DoesNotDependOnTheOrder) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int i = 0; i < 300; ++i) {
    const Pair pair = GetParam().make(random);
    const double tolerance = 8 * std::numeric_limits<double>::epsilon() * pair.largest_difference();
    const double forward = distance(pair).distance;
    ASSERT_NEAR(forward, distance({pair.q0, pair.q1, pair.p0, pair.p1}).distance, tolerance);
    ASSERT_NEAR(forward, distance({pair.p1, pair.p0, pair.q0, pair.q1}).distance, tolerance);
  }
}

INSTANTIATE_TEST_SUITE_P(Families, SegmentDistanceFamily, testing::ValuesIn(families),
                         [](const auto& instance) {
                           std::string name = instance.param.name;
                           std::replace(name.begin(), name.end(), '-', 'm');
                           return name;
                         });

TEST(SegmentDistance, FindsTheInteriorPoint) {
  const SegmentDistance found = segment_distance({-1, 0, 0}, {3, 0, 0}, {0, -1, 2}, {0, 1, 2});
  EXPECT_DOUBLE_EQ(found.s, 0.25);
  EXPECT_DOUBLE_EQ(found.t, 0.5);
  EXPECT_DOUBLE_EQ(found.distance, 2.0);
  EXPECT_EQ(found.delta, Vector3d(0, 0, 2));
}

}  // namespace
}  // namespace fiber::test
