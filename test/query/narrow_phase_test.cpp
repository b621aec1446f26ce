#include "fiber_proximity/query/for_engines/narrow_phase.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "test/support/assemblies.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(NarrowPhase, BoundsEveryGapFromBelow) {
  SCOPED_TRACE(seed_message());
  Random random;
  const QueryOptions options;
  for (const AssemblyFamily& family : assembly_families()) {
    SCOPED_TRACE(family.name);
    const FiberAssembly fibers = family.make(random);
    const FiberAssembly shape = family.make(random);
    const NarrowPhase test(shape, fibers, options);
    for (std::uint32_t a = 0; a + 1 < shape.point_count(); ++a) {
      for (std::uint32_t b = 0; b + 1 < fibers.point_count(); ++b) {
        ASSERT_LE(test.gap_lower_bound({a, b}), test.distance({a, b}).gap);
      }
    }
  }
}

/// Four points of two segments whose boxes are as far apart as they are.
using Quadruple = std::array<Vector3d, 4>;

/// In planes across an axis, crossing along it.
Quadruple crossing(Random& random) {
  const double below = random.uniform(-3.0, 0.0);
  const double above = random.uniform(0.0, 3.0);
  const auto near = [&] { return random.uniform(-0.1, 0.1); };
  const auto far = [&] { return random.uniform(0.1, 1.0); };
  return {Vector3d(-far(), near(), below), Vector3d(far(), near(), below),
          Vector3d(near(), -far(), above), Vector3d(near(), far(), above)};
}

/// One behind the other on an axis, with a gap much smaller than their length.
Quadruple in_line(Random& random) {
  return {Vector3d(0, 0, random.uniform(-3.0, -1.0)), Vector3d(0, 0, random.uniform(-1e-3, 0.0)),
          Vector3d(0, 0, random.uniform(0.0, 1e-3)), Vector3d(0, 0, random.uniform(1.0, 3.0))};
}

// Where the bound is as large as the gap but for roundings, these must be allowed for.
TEST(NarrowPhase, BoundsTheGapClosely) {
  SCOPED_TRACE(seed_message());
  Random random;
  const QueryOptions options;
  for (int round = 0; round < 10000; ++round) {
    const double scale = std::ldexp(1.0, random.integer(-1074, 490));
    const double radius = random.chance(0.5) ? 0.0 : random.uniform(0.0, 100.0);
    std::vector<Vector3d> points;
    for (const Vector3d& point : random.chance(0.5) ? crossing(random) : in_line(random)) {
      points.emplace_back(scale * point);
    }
    const FiberAssembly fibers(points, {0, 2, 4}, {scale * radius});
    const NarrowPhase test(fibers, options);
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
