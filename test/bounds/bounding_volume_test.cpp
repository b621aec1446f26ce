#include "src/bounds/bounding_volume.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/bounding_volumes.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// The properties every volume must have.
template <class Volume>
class BoundingVolumeTest : public testing::Test {};

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

std::vector<Capsule> random_run(Random& random, double scale) {
  std::vector<Capsule> run;
  const int size = random.integer(1, 12);
  const int kind = random.integer(0, 3);
  for (int i = 0; i < size; ++i) {
    Capsule capsule = random_capsule(random, scale);
    if (kind == 1 && i > 0) {  // a chain
      const Vector3d shift = run.back().p1 - capsule.p0;
      capsule.p0 += shift;
      capsule.p1 += shift;
    } else if (kind == 2 && i > 0) {  // collinear
      const Vector3d along = run.front().p1 - run.front().p0;
      capsule.p0 = run.front().p0 + random.uniform(-2, 2) * along;
      capsule.p1 = run.front().p0 + random.uniform(-2, 2) * along;
    } else if (kind == 3 && i > 0) {  // all the same
      capsule = run.front();
    }
    run.push_back(capsule);
  }
  return run;
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

TYPED_TEST(BoundingVolumeTest, ContainsItsCapsuleAndNoMuchLargerOne) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double scale : scales) {
    for (int i = 0; i < 1000; ++i) {
      const Capsule capsule = random_capsule(random, scale);
      const auto fit_volume = fitted<TypeParam>(capsule);
      ASSERT_TRUE(contains(fit_volume, capsule, parameters<TypeParam>())) << "scale " << scale;
      if (scale > 1e-10 && scale < 1e10) {
        const double reach = capsule.radius + (capsule.p1 - capsule.p0).norm() + 1e-3 * scale;
        ASSERT_FALSE(contains(fit_volume, Capsule{capsule.p0, capsule.p1, 2 * reach},
                              parameters<TypeParam>()))
            << "scale " << scale;
      }
    }
  }
}

TYPED_TEST(BoundingVolumeTest, OfARunContainsAllItsCapsules) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double scale : scales) {
    for (int i = 0; i < 500; ++i) {
      const std::vector<Capsule> run = random_run(random, scale);
      const auto fit_volume = fitted<TypeParam>(run);
      for (const Capsule& capsule : run) {
        ASSERT_TRUE(contains(fit_volume, capsule, parameters<TypeParam>())) << "scale " << scale;
      }
    }
  }
}

TYPED_TEST(BoundingVolumeTest, MergeContainsBoth) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double scale : scales) {
    for (int i = 0; i < 500; ++i) {
      const std::vector<Capsule> run_a = random_run(random, scale);
      const std::vector<Capsule> run_b = random_run(random, scale);
      const auto merged = merge(fitted<TypeParam>(run_a), fitted<TypeParam>(run_b));
      for (const std::vector<Capsule>* run : {&run_a, &run_b}) {
        for (const Capsule& capsule : *run) {
          ASSERT_TRUE(contains(merged, capsule, parameters<TypeParam>())) << "scale " << scale;
        }
      }
    }
  }
}

TYPED_TEST(BoundingVolumeTest, MergedLeavesContainBoth) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double scale : scales) {
    for (int i = 0; i < 500; ++i) {
      std::vector<Capsule> run = random_run(random, scale);
      run.push_back(random_capsule(random, scale));
      const auto merged =
          merge_leaves(fitted<TypeParam>(run[0]), fitted<TypeParam>(run[1]), run[0], run[1]);
      ASSERT_TRUE(contains(merged, run[0], parameters<TypeParam>())) << "scale " << scale;
      ASSERT_TRUE(contains(merged, run[1], parameters<TypeParam>())) << "scale " << scale;
    }
  }
}

TYPED_TEST(BoundingVolumeTest, MergedVolumesNeverMissWhatTheirPartsFind) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const double scale : scales) {
    for (int i = 0; i < 500; ++i) {
      const std::vector<Capsule> run = random_run(random, scale);
      const Capsule probe = random_capsule(random, scale);
      double nearest = std::numeric_limits<double>::infinity();
      for (const Capsule& capsule : run) {
        nearest = std::min(nearest, gap(capsule, probe));
      }
      auto merged = fitted<TypeParam>(run.front());
      for (const Capsule& capsule : run) {
        merged = merge(merged, fitted<TypeParam>(capsule));
      }
      const float margin = round_up(std::max(nearest, 0.0));
      for (const TypeParam& around : {merged, fitted<TypeParam>(run)}) {
        ASSERT_TRUE(overlaps(around, fitted<TypeParam>(probe), margin)) << "scale " << scale;
        ASSERT_LE(distance_lower_bound(around, fitted<TypeParam>(probe)), margin);
      }
    }
  }
}

TYPED_TEST(BoundingVolumeTest, VolumeIsAtLeastThatOfTheCapsuleAndFitsInItsBox) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int i = 0; i < rounds(200); ++i) {
    const Capsule capsule = random_capsule(random, 1.0);
    const auto fit_volume = fitted<TypeParam>(capsule);
    constexpr double pi = 3.14159265358979323846;
    const double r = capsule.radius;
    const double exact = pi * r * r * (capsule.p1 - capsule.p0).norm() + 4.0 / 3.0 * pi * r * r * r;
    const double found = volume(fit_volume, parameters<TypeParam>());
    const Aabb box = bounding_box(fit_volume, parameters<TypeParam>());
    ASSERT_GE(found, exact);
    double box_volume = 1.0;  // with room for a padding or two
    for (int axis = 0; axis < 3; ++axis) {
      const auto lower = static_cast<double>(box.lower[axis]);
      const auto upper = static_cast<double>(box.upper[axis]);
      ASSERT_LE(lower, capsule.p0[axis] - r + 1e-6);
      ASSERT_GE(upper, capsule.p1[axis] + r - 1e-6);
      box_volume *= upper - lower + 1e-5;
    }
    ASSERT_LE(found, box_volume);
  }
}

TYPED_TEST(BoundingVolumeTest, AnswersStaySafeUnderRigidMotion) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int i = 0; i < 1000; ++i) {
    Capsule a = random_capsule(random, 1.0);
    Capsule b = random_capsule(random, 1.0);
    const double before = gap(a, b);
    const Eigen::Quaterniond rotation = random.rotation();
    const Vector3d shift = random.in_cube(10.0);
    for (Capsule* capsule : {&a, &b}) {
      capsule->p0 = rotation * capsule->p0 + shift;
      capsule->p1 = rotation * capsule->p1 + shift;
    }
    const float margin = round_up(std::max(before, 0.0) + 1e-12);
    ASSERT_TRUE(overlaps(fitted<TypeParam>(a), fitted<TypeParam>(b), margin));
  }
}

TYPED_TEST(BoundingVolumeTest, SplitAxesComeLongestFirst) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int i = 0; i < 200; ++i) {
    const std::vector<Capsule> run = random_run(random, 1.0);
    const auto axes = split_axes(fitted<TypeParam>(run), CapsuleRun{run.data(), run.size()},
                                 parameters<TypeParam>());
    ASSERT_GE(axes.size(), 3U);
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      ASSERT_NEAR(axes[axis].direction.norm(), 1.0, 1e-5);
      ASSERT_TRUE(axis == 0 || axes[axis].extent <= axes[axis - 1].extent);
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
    const float forward = distance_lower_bound(a, b);
    const float backward = distance_lower_bound(b, a);
    ASSERT_NEAR(forward, backward, 1e-5F);
    // Rounding may decide a pair one way here and the other way there only at the very margin.
    ASSERT_TRUE(overlaps(a, b, margin + 1e-5F) || !overlaps(b, a, margin));
  }
}

TYPED_TEST(BoundingVolumeTest, SeparatesWhatIsFarApart) {
  const auto near_origin = fitted<TypeParam>(Capsule{{0, 0, 0}, {1, 0, 0}, 0.1});
  const auto far_away = fitted<TypeParam>(Capsule{{0, 10, 0}, {1, 10, 0}, 0.1});
  EXPECT_FALSE(overlaps(near_origin, far_away, 1.0F));
  EXPECT_GT(distance_lower_bound(near_origin, far_away), 1.0F);
  EXPECT_LE(distance_lower_bound(near_origin, near_origin), 0.0F);
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
  const auto box = fitted<Aabb>(Capsule{{0, 0, 0}, {1, 2, 3}, 0.5});
  EXPECT_NEAR(box.lower[0], -0.5, 1e-5);
  EXPECT_NEAR(box.upper[2], 3.5, 1e-5);
  EXPECT_LT(box.lower[0], -0.5F);
  EXPECT_GT(box.upper[2], 3.5F);
}

}  // namespace
}  // namespace fiber::test
