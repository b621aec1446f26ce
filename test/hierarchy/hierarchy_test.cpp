#include "fiber_proximity/hierarchy/hierarchy.hpp"

#include <gtest/gtest.h>

#include "fiber_proximity/bounds/aabb.hpp"
#include "support/assemblies.hpp"

namespace fiber::test {
namespace {

TEST(Hierarchy, RefitEqualsRebuild) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 20; ++round) {
    AssemblyBuilder before;
    AssemblyBuilder after;
    for (int fiber = 0; fiber < 5; ++fiber) {
      const int segments = random.integer(1, 30);
      before.add_fiber(random_walk(random, segments, 0.1));
      after.add_fiber(random_walk(random, segments, 0.1));
    }
    const FiberAssembly moved = after.build({0.01});
    Hierarchy<Aabb> refitted;
    refitted.build(before.build({0.02}), random.in_cube());
    const Eigen::Vector3d origin = random.in_cube();
    refitted.update(moved, origin);
    Hierarchy<Aabb> rebuilt;
    rebuilt.build(moved, origin);
    ASSERT_EQ(refitted.tree().node_count(), rebuilt.tree().node_count());
    for (std::uint32_t node = 0; node < rebuilt.tree().node_count(); ++node) {
      ASSERT_EQ(refitted.volume(node).lower, rebuilt.volume(node).lower);
      ASSERT_EQ(refitted.volume(node).upper, rebuilt.volume(node).upper);
    }
  }
}

}  // namespace
}  // namespace fiber::test
