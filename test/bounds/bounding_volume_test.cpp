#include "fiber_proximity/bounds/bounding_volume.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fiber_proximity/bounds/aabb.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"
#include "support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// The properties every volume must have; one line in VolumeTypes adds a volume.
template <class Volume>
class BoundingVolumeTest : public testing::Test {};

using VolumeTypes = testing::Types<Aabb>;
TYPED_TEST_SUITE(BoundingVolumeTest, VolumeTypes);

/// Capsules of all kinds: from points to needles, from far below to far beyond float's range.
Capsule random_capsule(Random& random, double scale) {
  const Vector3d p0 = scale * random.in_cube();
  const double length = random.chance(0.1) ? 0.0 : std::pow(10.0, random.uniform(-6.0, 0.0));
  Vector3d direction = random.direction();
  if (random.chance(0.2)) {
    direction = Vector3d::Unit(random.integer(0, 2));
  }
  const double radius = random.chance(0.2) ? 0.0 : std::pow(10.0, random.uniform(-6.0, 0.0));
  return {p0, p0 + scale * length * direction, scale * radius};
}

constexpr double scales[] = {1e-310, 1e-40, 1e-20, 1e-3, 1.0, 1e6, 1e30, 1e60};

double gap(const Capsule& a, const Capsule& b) {
  return segment_distance(a.p0, a.p1, b.p0, b.p1).distance - (a.radius + b.radius);
}

template <class Volume>
Volume fitted(const Capsule& capsule) {
  Volume volume;
  fit(volume, capsule);
  return volume;
}

TYPED_TEST(BoundingVolumeTest, OverlapNeverMissesACapsule) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double scale : scales) {
    for (int i = 0; i < 2000; ++i) {
      const Capsule a = random_capsule(random, scale);
      Capsule b = random_capsule(random, scale);
      // Half of the pairs just touch.
      if (random.chance(0.5)) {
        const SegmentDistance nearest = segment_distance(a.p0, a.p1, b.p0, b.p1);
        b.radius = std::max(0.0, nearest.distance - a.radius);
      }
      const double margin = std::max(gap(a, b), 0.0);
      ASSERT_TRUE(overlaps(fitted<TypeParam>(a), fitted<TypeParam>(b), round_up(margin)))
          << "scale " << scale << ", pair " << i;
    }
  }
}

TYPED_TEST(BoundingVolumeTest, LowerBoundIsNeverAboveTheDistance) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double scale : scales) {
    for (int i = 0; i < 2000; ++i) {
      const Capsule a = random_capsule(random, scale);
      const Capsule b = random_capsule(random, scale);
      const float bound = distance_lower_bound(fitted<TypeParam>(a), fitted<TypeParam>(b));
      ASSERT_LE(bound, round_up(std::max(gap(a, b), 0.0))) << "scale " << scale << ", pair " << i;
    }
  }
}

TYPED_TEST(BoundingVolumeTest, MergeContainsBoth) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double scale : scales) {
    for (int i = 0; i < 1000; ++i) {
      const Capsule a = random_capsule(random, scale);
      const Capsule b = random_capsule(random, scale);
      const TypeParam merged = merge(fitted<TypeParam>(a), fitted<TypeParam>(b));
      // A sphere that touches a or b from any side must be found by the merged volume.
      const Capsule& inside = random.chance(0.5) ? a : b;
      const double t = random.uniform(0.0, 1.0);
      const Vector3d surface =
          (1 - t) * inside.p0 + t * inside.p1 + inside.radius * random.direction();
      const Capsule probe{surface, surface, 0.0};
      ASSERT_TRUE(overlaps(merged, fitted<TypeParam>(probe), 0.0F)) << "scale " << scale;
    }
  }
}

TYPED_TEST(BoundingVolumeTest, TestsAreSymmetric) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int i = 0; i < 2000; ++i) {
    const TypeParam a = fitted<TypeParam>(random_capsule(random, 1.0));
    const TypeParam b = fitted<TypeParam>(random_capsule(random, 1.0));
    const float margin = static_cast<float>(random.uniform(0.0, 1.0));
    ASSERT_EQ(overlaps(a, b, margin), overlaps(b, a, margin));
    ASSERT_EQ(distance_lower_bound(a, b), distance_lower_bound(b, a));
  }
}

TYPED_TEST(BoundingVolumeTest, SeparatesWhatIsFarApart) {
  const auto near_origin = fitted<TypeParam>({{0, 0, 0}, {1, 0, 0}, 0.1});
  const auto far_away = fitted<TypeParam>({{0, 10, 0}, {1, 10, 0}, 0.1});
  EXPECT_FALSE(overlaps(near_origin, far_away, 1.0F));
  EXPECT_GT(distance_lower_bound(near_origin, far_away), 1.0F);
  EXPECT_EQ(distance_lower_bound(near_origin, near_origin), 0.0F);
}

TEST(RoundUp, IsTheSmallestFloatNotBelow) {
  EXPECT_EQ(round_up(0.0), 0.0F);
  EXPECT_EQ(round_up(0.5), 0.5F);
  EXPECT_GT(static_cast<double>(round_up(0.1)), 0.1 - 1e-12);
  EXPECT_GE(static_cast<double>(round_up(1e-60)), 1e-60);
  EXPECT_EQ(round_up(1e60), std::numeric_limits<float>::infinity());
  EXPECT_EQ(round_up(std::numeric_limits<double>::infinity()),
            std::numeric_limits<float>::infinity());
  SCOPED_TRACE(seed_message());
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const double x = std::pow(10.0, random.uniform(-30.0, 30.0));
    const float up = round_up(x);
    ASSERT_GE(static_cast<double>(up), x);
    ASSERT_LT(static_cast<double>(std::nextafter(up, 0.0F)), x);
  }
}

TEST(Aabb, IsAsTightAsItsPaddingSays) {
  const auto box = fitted<Aabb>({{0, 0, 0}, {1, 2, 3}, 0.5});
  EXPECT_NEAR(box.lower[0], -0.5, 1e-5);
  EXPECT_NEAR(box.upper[2], 3.5, 1e-5);
  EXPECT_LT(box.lower[0], -0.5F);
  EXPECT_GT(box.upper[2], 3.5F);
}

}  // namespace
}  // namespace fiber::test
