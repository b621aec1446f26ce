#include "src/hierarchy/run_tree.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fiber_proximity/scenes/scene.hpp"
#include "src/query/run_tree_engine.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"

namespace fiber::test {
namespace {

/// Fibres all over a cube of this size, thick enough to touch.
FiberAssembly tangle(Random& random, int fibers, int segments, double size, double radius) {
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < fibers; ++fiber) {
    std::vector<Eigen::Vector3d> walk = random_walk(random, segments, 0.02);
    for (Eigen::Vector3d& point : walk) {
      point *= size;
    }
    builder.add_fiber(walk);
  }
  return builder.build({radius});
}

QueryResult contacts_of(const FiberAssembly& fibers, std::uint32_t threads,
                        const QueryOptions& options = {}) {
  RunTreeEngine engine({threads});
  engine.update(fibers);
  return answer(engine, options);
}

TEST(RunTree, HoldsEverySegmentOnce) {
  SCOPED_TRACE(seed_message());
  Random random;
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 60; ++fiber) {
    builder.add_fiber(random_walk(random, random.integer(1, 40), 0.1));
  }
  const FiberAssembly fibers = builder.build({0.01});
  RunTree tree;
  tree.build({fibers, Eigen::Vector3d::Zero()});
  std::vector<int> seen(fibers.point_count(), 0);
  for (std::uint32_t place = 0; place < tree.view().segment_count; ++place) {
    const std::uint32_t point = tree.view().first_points[place];
    ++seen[point];
    const fiber::Run& run = tree.view().runs[place / run_width];
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(run.start[axis][place % run_width],
                static_cast<float>(fibers.points()[point][axis]));
      EXPECT_EQ(run.end[axis][place % run_width],
                static_cast<float>(fibers.points()[point + 1][axis]));
    }
  }
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
    for (std::uint32_t point = fibers.offsets()[fiber]; point <= last; ++point) {
      EXPECT_EQ(seen[point], point == last ? 0 : 1) << "point " << point;
    }
  }
}

TEST(RunTree, AnswersTheSameWithEveryInstructionSet) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 60, 40, 1.0, 0.03);
  for (const QueryType type : {QueryType::ALL, QueryType::FIRST, QueryType::CLOSEST}) {
    const QueryOptions options = within(0.0, type);
    QueryResult expected = brute_force(fibers, options);
    ASSERT_FALSE(expected.contacts.empty());
    if (type == QueryType::FIRST) {
      expected = contacts_of(fibers, 1, options);  // which one is the engine's choice
    }
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      EXPECT_TRUE(same_contacts(contacts_of(fibers, 2, options).contacts, expected.contacts))
          << hwy::TargetName(target);
    }
    hwy::SetSupportedTargetsForTest(0);
  }
}

TEST(RunTree, AnswersTheSameWithAnyNumberOfThreads) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = tangle(random, 600, 80, 1.0, 0.002);
  const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 7);
  const QueryResult expected = contacts_of(fibers, 1);
  expect_enough(expected.contacts.size(), std::size_t{101});
  for (const std::uint32_t threads : {2U, 3U, 7U}) {
    EXPECT_TRUE(same_contacts(contacts_of(fibers, threads).contacts, expected.contacts));
  }
}

TEST(RunTree, SortsAnewWhenTheOrderHasDecayedAndNotBefore) {
  SCOPED_TRACE(seed_message());
  Random random;
  FiberAssembly fibers = tangle(random, 300, 20, 1.0, 0.002);
  RunTree tree;
  tree.build({fibers, Eigen::Vector3d::Zero()});
  std::vector<Eigen::Vector3d> points = fibers.points();
  for (Eigen::Vector3d& point : points) {
    point += 1e-4 * random.in_cube();
  }
  fibers.update_points(points);
  tree.update({fibers, Eigen::Vector3d::Zero()});
  EXPECT_EQ(tree.sort_count(), 0U);

  // Every fibre somewhere else: the old order says nothing any more.
  const FiberAssembly elsewhere = tangle(random, 300, 20, 1.0, 0.002);
  fibers.update_points(elsewhere.points());
  tree.update({fibers, Eigen::Vector3d::Zero()});
  EXPECT_EQ(tree.sort_count(), 1U);
  tree.update({fibers, Eigen::Vector3d::Zero()});
  EXPECT_EQ(tree.sort_count(), 1U);
}

TEST(RunTree, EqualsBruteForceWhateverSizeAndPlace) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t found = 0;
  for (int round = 0; round < 300; ++round) {
    const double size = std::pow(10.0, random.uniform(-12.0, 12.0));
    const double thickness = random.chance(0.2) ? 0.0 : random.uniform(0.0, 0.05);
    FiberAssembly fibers = tangle(random, 1 + round % 12, 1 + round % 23, size, thickness * size);
    const double away = random.chance(0.5) ? 0.0 : 1e6 * random.uniform(0.0, 1.0);
    std::vector<Eigen::Vector3d> points = fibers.points();
    flatten_some(points, random);
    for (Eigen::Vector3d& point : points) {
      point += away * size * Eigen::Vector3d(1.0, -0.5, 0.3);
    }
    fibers.update_points(points);
    QueryOptions options;
    options.margin = round % 3 == 0 ? 0.0 : random.uniform(0.0, 0.1) * size;
    options.neighbour_skip = 1;  // many contacts: neighbours' too
    QueryResult expected = brute_force(fibers, options);
    if (round % 3 == 1 && !expected.contacts.empty()) {
      // Exactly what one pair is apart: rounding decides whether it is found.
      const int which = random.integer(0, static_cast<int>(expected.contacts.size()) - 1);
      options.margin = std::max(0.0, expected.contacts[static_cast<std::size_t>(which)].distance);
      expected = brute_force(fibers, options);
    }
    EXPECT_TRUE(same_contacts(contacts_of(fibers, 1, options).contacts, expected.contacts))
        << "size " << size << ", away " << away;
    found += expected.contacts.size();
  }
  expect_enough(found, std::size_t{1001});
}

}  // namespace
}  // namespace fiber::test
