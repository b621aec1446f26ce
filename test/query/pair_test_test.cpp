#include "fiber_proximity/query/pair_test.hpp"

#include <gtest/gtest.h>

#include "support/assemblies.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(PairTest, BoundsEveryGapFromBelow) {
  SCOPED_TRACE(seed_message());
  Random random;
  const QueryOptions options;
  for (const AssemblyFamily& family : assembly_families()) {
    SCOPED_TRACE(family.name);
    const FiberAssembly fibers = family.make(random);
    const FiberAssembly shape = family.make(random);
    const PairTest test(shape, fibers, options);
    for (std::uint32_t a = 0; a + 1 < shape.point_count(); ++a) {
      for (std::uint32_t b = 0; b + 1 < fibers.point_count(); ++b) {
        ASSERT_LE(test.gap_lower_bound({a, b}), test.distance({a, b}).gap);
      }
    }
  }
}

// Crossing in planes across an axis: the boxes are as far apart as the segments, up to rounding.
TEST(PairTest, BoundsTheGapClosely) {
  SCOPED_TRACE(seed_message());
  Random random;
  const QueryOptions options;
  for (int round = 0; round < 10000; ++round) {
    const double scale = std::ldexp(1.0, random.integer(-1060, 490));
    const double radius = random.chance(0.5) ? 0.0 : random.uniform(0.0, 100.0);
    const Vector3d a{-random.uniform(0.1, 1.0), random.uniform(-0.1, 0.1), random.uniform(-3, 0)};
    const Vector3d b{random.uniform(0.1, 1.0), random.uniform(-0.1, 0.1), a.z()};
    const Vector3d c{random.uniform(-0.1, 0.1), -random.uniform(0.1, 1.0), random.uniform(0, 3)};
    const Vector3d d{random.uniform(-0.1, 0.1), random.uniform(0.1, 1.0), c.z()};
    const FiberAssembly fibers({scale * a, scale * b, scale * c, scale * d}, {0, 2, 4},
                               {scale * radius});
    const PairTest test(fibers, options);
    for (const PointPair pair : {PointPair{0, 2}, PointPair{2, 0}}) {
      const double gap = test.distance(pair).gap;
      const double bound = test.gap_lower_bound(pair);
      ASSERT_LE(bound, gap) << "round " << round;
      if (scale > 0x1p-900) {
        ASSERT_GT(bound, gap - 1e-12 * (1.0 + radius) * scale) << "round " << round;
      }
    }
  }
}

}  // namespace
}  // namespace fiber::test
