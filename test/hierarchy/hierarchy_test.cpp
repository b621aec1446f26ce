#include "src/paper/hierarchy/hierarchy.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <type_traits>
#include <vector>

#include "src/bounds/aabb.hpp"
#include "src/paper/bounds/direction_set.hpp"
#include "src/paper/bounds/kdop.hpp"
#include "src/paper/bounds/obb.hpp"
#include "src/paper/bounds/sphere.hpp"
#include "test/support/assemblies.hpp"

namespace fiber::test {
namespace {

constexpr int kdop_k = 20;

template <class Kind>
Kind make_hierarchy() {
  if constexpr (std::is_same_v<typename Kind::Parameters, NoParameters>) {
    return Kind();
  } else {
    return Kind(typename Kind::Parameters(grassmannian_directions(kdop_k)));
  }
}

/// What every kind of hierarchy promises, over every volume.
template <class Kind>
class HierarchyTest : public testing::Test {};

using Kinds =
    testing::Types<LayeredHierarchy<Aabb>, LayeredHierarchy<Kdop<3>>, LayeredHierarchy<Sphere>,
                   LayeredHierarchy<Obb>, WrappedHierarchy<Aabb>, WrappedHierarchy<Kdop<3>>,
                   WrappedHierarchy<Sphere>, WrappedHierarchy<Obb>, SpatialHierarchy<Aabb>,
                   SpatialHierarchy<Kdop<3>>, SpatialHierarchy<Sphere>, SpatialHierarchy<Obb>,
                   CascadedHierarchy>;
TYPED_TEST_SUITE(HierarchyTest, Kinds);

/// Every node's volume contains every segment below it.
template <class Kind>
testing::AssertionResult encloses_all(const Kind& hierarchy, const FiberAssembly& fibers) {
  const BinaryTree& tree = hierarchy.tree();
  std::vector<std::vector<std::uint32_t>> below(tree.node_count());
  std::size_t leaves = 0;
  for (std::uint32_t node = tree.node_count(); node-- > 0;) {
    if (tree.is_leaf(node)) {
      below[node] = {tree.leaf_point(node)};
      ++leaves;
    } else {
      for (const std::uint32_t child : {tree.first_child(node), tree.first_child(node) + 1}) {
        below[node].insert(below[node].end(), below[child].begin(), below[child].end());
      }
    }
    for (const std::uint32_t point : below[node]) {
      Capsule capsule = fibers.capsule(point);
      capsule.p0 -= hierarchy.origin();
      capsule.p1 -= hierarchy.origin();
      if (!contains(hierarchy.volume(node), capsule, hierarchy.parameters())) {
        return testing::AssertionFailure() << "node " << node << " misses segment " << point;
      }
    }
  }
  if (leaves != fibers.segment_count()) {
    return testing::AssertionFailure() << leaves << " leaves";
  }
  return testing::AssertionSuccess();
}

TYPED_TEST(HierarchyTest, EveryNodeContainsTheSegmentsBelowIt) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : assembly_families()) {
    for (int round = 0; round < 5; ++round) {
      const FiberAssembly fibers = family.make(random);
      const Eigen::Vector3d origin =
          fibers.points().empty() ? Eigen::Vector3d::Zero() : fibers.points().front();
      auto hierarchy = make_hierarchy<TypeParam>();
      hierarchy.build(fibers, origin);
      ASSERT_TRUE(encloses_all(hierarchy, fibers)) << family.name;
    }
  }
}

TYPED_TEST(HierarchyTest, EveryNodeContainsTheSegmentsBelowItAfterAnUpdate) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 20; ++round) {
    FiberAssembly fibers = assembly_families()[random.integer(0, 2)].make(random);
    auto hierarchy = make_hierarchy<TypeParam>();
    hierarchy.build(fibers, fibers.points().front());
    for (int frame = 0; frame < 3; ++frame) {
      std::vector<Eigen::Vector3d> points = fibers.points();
      for (Eigen::Vector3d& point : points) {
        point += std::pow(0.1, frame) * random.in_cube();
      }
      fibers.update_points(points);
      hierarchy.update(fibers, points.front());
      ASSERT_TRUE(encloses_all(hierarchy, fibers));
    }
  }
}

TYPED_TEST(HierarchyTest, RefitEqualsRebuild) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 10; ++round) {
    FiberAssembly fibers = assembly_families()[0].make(random);
    auto refitted = make_hierarchy<TypeParam>();
    refitted.build(fibers, random.in_cube());
    std::vector<Eigen::Vector3d> points = fibers.points();
    for (Eigen::Vector3d& point : points) {
      point += random.in_cube();
    }
    fibers.update_points(points);
    const Eigen::Vector3d origin = random.in_cube();
    refitted.update(fibers, origin);
    auto rebuilt = make_hierarchy<TypeParam>();
    rebuilt.build(fibers, origin);
    ASSERT_EQ(refitted.tree().node_count(), rebuilt.tree().node_count());
    for (std::uint32_t node = 0; node < rebuilt.tree().node_count(); ++node) {
      const auto& parameters = rebuilt.parameters();
      const double size = volume(rebuilt.volume(node), parameters);
      // Cascade verification may keep another basis of the same sphere.
      ASSERT_NEAR(volume(refitted.volume(node), parameters), size, 1e-5 * size) << "node " << node;
    }
  }
}

template <class Volume>
void expect_wrapped_equals_layered() {
  SCOPED_TRACE(seed_message());
  Random random;
  for (const AssemblyFamily& family : assembly_families()) {
    const FiberAssembly fibers = family.make(random);
    const Eigen::Vector3d origin = random.in_cube();
    auto layered = make_hierarchy<LayeredHierarchy<Volume>>();
    auto wrapped = make_hierarchy<WrappedHierarchy<Volume>>();
    layered.build(fibers, origin);
    wrapped.build(fibers, origin);
    ASSERT_EQ(layered.tree().node_count(), wrapped.tree().node_count());
    for (std::uint32_t node = 0; node < layered.tree().node_count(); ++node) {
      const Volume& one = layered.volume(node);
      const Volume& other = wrapped.volume(node);
      // Bit for bit. NOLINTBEGIN(bugprone-suspicious-memory-comparison)
      ASSERT_EQ(std::memcmp(&one.lower, &other.lower, sizeof one.lower), 0) << family.name;
      ASSERT_EQ(std::memcmp(&one.upper, &other.upper, sizeof one.upper), 0) << family.name;
      // NOLINTEND(bugprone-suspicious-memory-comparison)
    }
  }
}

// Sect. 4.2.2 of the paper.
TEST(WrappedHierarchy, EqualsTheLayeredOneForDops) {
  expect_wrapped_equals_layered<Aabb>();
  expect_wrapped_equals_layered<Kdop<3>>();
}

FiberAssembly long_walk(Random& random) { return walks(random, 4, 200, 0.05, 0.01); }

TEST(CascadedHierarchy, RecomputesNothingWhereNothingMoved) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = long_walk(random);
  CascadedHierarchy hierarchy;
  hierarchy.build(fibers, fibers.points().front());
  EXPECT_EQ(hierarchy.recomputed_count(), fibers.segment_count() - 1);
  hierarchy.update(fibers, fibers.points().front());
  EXPECT_EQ(hierarchy.recomputed_count(), 0U);
}

TEST(CascadedHierarchy, RecomputesOnlyWhereABasisBroke) {
  SCOPED_TRACE(seed_message());
  Random random;
  FiberAssembly fibers = long_walk(random);
  CascadedHierarchy hierarchy;
  hierarchy.build(fibers, fibers.points().front());
  // One point flies away: only its ancestors can break.
  std::vector<Eigen::Vector3d> points = fibers.points();
  points[300] += Eigen::Vector3d(100.0, 0.0, 0.0);
  fibers.update_points(points);
  hierarchy.update(fibers, points.front());
  EXPECT_GT(hierarchy.recomputed_count(), 0U);
  EXPECT_LE(hierarchy.recomputed_count(), 2U * hierarchy.tree().level_count());
}

TEST(CascadedHierarchy, FollowsASmoothMotionWithFewRecomputations) {
  SCOPED_TRACE(seed_message());
  Random random;
  FiberAssembly fibers = long_walk(random);
  CascadedHierarchy hierarchy;
  hierarchy.build(fibers, fibers.points().front());
  std::vector<Eigen::Vector3d> points = fibers.points();
  for (Eigen::Vector3d& point : points) {
    point += 1e-5 * random.in_cube();
  }
  fibers.update_points(points);
  hierarchy.update(fibers, points.front());
  EXPECT_LT(hierarchy.recomputed_count(), fibers.segment_count() / 10);
}

}  // namespace
}  // namespace fiber::test
