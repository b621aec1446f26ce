// Many pairs at once give the bits of one pair alone, whatever the instruction set.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Segments of all kinds one after the other, two points each.
std::vector<Vector3d> random_segments(Random& random, int count) {
  std::vector<Vector3d> points;
  for (int i = 0; i < count; ++i) {
    const double scale = random.chance(0.1) ? std::pow(10.0, random.uniform(-150.0, 140.0)) : 1.0;
    points.push_back(scale * random.in_cube());
    switch (random.integer(0, 5)) {
      case 0:  // no length
        points.push_back(points.back());
        break;
      case 1:  // parallel to an axis: many are parallel to each other
        points.push_back(points.back() + scale * Vector3d::Unit(random.integer(0, 2)));
        break;
      case 2:  // nearly so
        points.push_back(points.back() + scale * (Vector3d::UnitX() + 1e-9 * random.in_cube()));
        break;
      default:
        points.push_back(scale * random.in_cube());
    }
  }
  return points;
}

bool same_bits(const SegmentDistance& x, const SegmentDistance& y) {
  return x.s == y.s && x.t == y.t && x.delta == y.delta && x.distance == y.distance &&
         x.error == y.error;
}

using Batch = void (*)(const Vector3d* const*, const Vector3d* const*, std::size_t,
                       SegmentDistance*);

void expect_same_bits(Kernel kernel, Batch batch) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 200; ++round) {
    const int count = random.integer(0, 70);
    const std::vector<Vector3d> points = random_segments(random, 2 * count);
    std::vector<const Vector3d*> a;
    std::vector<const Vector3d*> b;
    std::vector<SegmentDistance> expected;
    for (std::size_t i = 0; i < points.size(); i += 4) {
      a.push_back(&points[i]);
      b.push_back(&points[i + 2]);
      expected.push_back(
          segment_distance(kernel, points[i], points[i + 1], points[i + 2], points[i + 3]));
    }
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      std::vector<SegmentDistance> found(a.size());
      batch(a.data(), b.data(), a.size(), found.data());
      for (std::size_t i = 0; i < found.size(); ++i) {
        EXPECT_TRUE(same_bits(found[i], expected[i]))
            << hwy::TargetName(target) << ", pair " << i << " of " << found.size();
      }
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

TEST(SegmentDistances, EqualOnePairAlone) { expect_same_bits(Kernel::ROBUST, segment_distances); }

}  // namespace
}  // namespace fiber::test
