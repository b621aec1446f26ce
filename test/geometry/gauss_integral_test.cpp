#include "src/geometry/gauss_integral.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/support/curves.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(GaussIntegral, IsThatOfNumericalIntegration) {
  SCOPED_TRACE(seed_message());
  Random random(21);
  for (int round = 0; round < 20; ++round) {
    const Vector3d p0 = random.in_cube();
    const Vector3d p1 = random.in_cube();
    const Vector3d shift = 3.0 * random.direction();
    const Vector3d q0 = shift + random.in_cube();
    const Vector3d q1 = shift + random.in_cube();
    const Vector3d area = (p1 - p0).cross(q1 - q0);
    constexpr int steps = 200;
    double sum = 0.0;
    for (int i = 0; i < steps; ++i) {
      for (int j = 0; j < steps; ++j) {
        const Vector3d r = p0 + (i + 0.5) / steps * (p1 - p0) - q0 - (j + 0.5) / steps * (q1 - q0);
        sum += r.dot(area) / std::pow(r.norm(), 3.0);
      }
    }
    EXPECT_NEAR(gauss_integral(p0, p1, q0, q1), sum / (steps * steps) / (2.0 * turn), 1e-4);
    EXPECT_NEAR(gauss_integral(p0, p1, q0, q1), -gauss_integral(p1, p0, q0, q1), 1e-15);
    EXPECT_NEAR(gauss_integral(p0, p1, q0, q1), gauss_integral(q0, q1, p0, p1), 1e-15);
  }
}

// Two crossing segments of infinite length at right angles are seen to cross from everywhere.
TEST(GaussIntegral, OfLongSegmentsIsAHalfAndOfFlatOnesNothing) {
  EXPECT_NEAR(gauss_integral({-1e6, 0, 1}, {1e6, 0, 1}, {0, -1e6, 0}, {0, 1e6, 0}), 0.5, 1e-5);
  EXPECT_NEAR(gauss_integral({-1, 0, 1e-12}, {1, 0, 1e-12}, {0, -1, 0}, {0, 1, 0}), 0.5, 1e-10);
  EXPECT_EQ(gauss_integral({-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}), 0.0) << "touching";
  EXPECT_EQ(gauss_integral({0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}), 0.0) << "collinear";
  EXPECT_EQ(gauss_integral({0, 0, 0}, {1, 0, 0}, {0, 1, 1}, {1, 1, 1}), 0.0) << "parallel";
  EXPECT_EQ(gauss_integral({0, 0, 0}, {0, 0, 0}, {0, 1, 1}, {1, 1, 1}), 0.0) << "no length";
  EXPECT_EQ(gauss_integral({0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}), 0.0) << "one point";
}

TEST(GaussIntegral, KnowsNoUnits) {
  const Vector3d p0(0.1, 0.2, 0.9);
  const Vector3d p1(1.2, -0.3, 0.8);
  const Vector3d q0(0.4, -1.1, 0.1);
  const Vector3d q1(0.3, 1.7, -0.2);
  const double expected = gauss_integral(p0, p1, q0, q1);
  for (const double scale : {0x1p-1000, 0x1p-400, 0x1p490}) {
    EXPECT_NEAR(gauss_integral(scale * p0, scale * p1, scale * q0, scale * q1), expected, 1e-14);
  }
}

// Nearly straight curves, and segments that nearly touch in the middle or at a diagonal: no digits
// are lost to the way it is computed.
TEST(GaussIntegral, IsAccurateWhereAnglesAreSmallOrLarge) {
  for (const double bend : {1e-2, 1e-5, 1e-8}) {
    // Far segments of small angles have about volume / distance³ / 4π.
    const double found = gauss_integral({0, 0, 0}, {1, bend, 0}, {1e3, 0, 0}, {1e3 + 1, 0, bend});
    const double expected = -1e3 * bend * bend / 1e9 / (2.0 * turn);
    EXPECT_NEAR(found / expected, 1.0, 1e-2) << bend;
  }
  for (const double shift : {0.0, 0.3, 0.7}) {
    for (const double gap : {1e-9, 1e-12}) {
      // An infinitely thin gap makes a half; it is less by about the gap over the lengths.
      EXPECT_NEAR(gauss_integral({-1, shift, gap}, {1, shift, gap}, {0, -1, 0}, {0, 1, 0}), 0.5,
                  10.0 * gap)
          << shift;
      EXPECT_NEAR(gauss_integral({-1, -1, -gap}, {1, 1.1, -gap}, {0.5, 0, 0}, {-0.5, shift, 0}),
                  -gauss_integral({-1, -1, gap}, {1, 1.1, gap}, {0.5, 0, 0}, {-0.5, shift, 0}),
                  1e-15);
    }
  }
}

// Segments that share a point, by index or not, in any position: rounding must not count.
TEST(GaussIntegral, OfSegmentsThatMeetIsNothing) {
  SCOPED_TRACE(seed_message());
  Random random(22);
  for (int round = 0; round < 1000; ++round) {
    const Vector3d a = random.in_cube();
    const Vector3d b = random.in_cube();
    const Vector3d c = random.in_cube();
    EXPECT_EQ(gauss_integral(a, b, b, c), 0.0);
    EXPECT_EQ(gauss_integral(b, a, b, c), 0.0);
    EXPECT_EQ(gauss_integral(a, b, c, a), 0.0);
  }
}

}  // namespace
}  // namespace fiber::test
