#include "fiber_proximity/query/fiber_snapshots.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace fiber::test {
namespace {

/// Two parallel fibres, this far apart.
FiberAssembly apart(double distance) {
  return {{{0, 0, 0}, {1, 0, 0}, {0, distance, 0}, {1, distance, 0}}, {0, 2, 4}, {0.0}};
}

double distance_in(const FiberSnapshot& snapshot) {
  QueryOptions options;
  options.margin = 1e3;
  QueryResult result;
  snapshot.engine->query(options, result);
  return result.contacts.at(0).distance;
}

TEST(FiberSnapshots, StayAsTheyAreWhileHeld) {
  FiberSnapshots snapshots;
  EXPECT_EQ(snapshots.newest(), nullptr);
  snapshots.apply(apart(1.0));
  const std::shared_ptr<const FiberSnapshot> first = snapshots.newest();
  for (int i = 2; i < 10; ++i) {
    snapshots.apply(apart(i));
    EXPECT_EQ(distance_in(*snapshots.newest()), i);
  }
  EXPECT_EQ(distance_in(*first), 1.0);
}

TEST(FiberSnapshots, AreUsedAgainWhenNobodyHoldsThem) {
  FiberSnapshots snapshots;
  snapshots.apply(apart(1.0));
  const FiberSnapshot* first = snapshots.newest().get();
  snapshots.apply(apart(2.0));
  const FiberSnapshot* second = snapshots.newest().get();
  EXPECT_NE(first, second);
  snapshots.apply(apart(3.0));
  EXPECT_EQ(snapshots.newest().get(), first);
}

TEST(FiberSnapshots, AnswerManyThreadsWhileTheNextAreApplied) {
  FiberSnapshots snapshots;
  snapshots.apply(apart(1.0));
  std::atomic<bool> go_on{true};
  std::vector<std::thread> readers;
  for (int i = 0; i < 3; ++i) {
    readers.emplace_back([&] {
      while (go_on) {
        const std::shared_ptr<const FiberSnapshot> snapshot = snapshots.newest();
        ASSERT_EQ(distance_in(*snapshot), snapshot->fibers.points()[2].y());
      }
    });
  }
  for (int i = 1; i < 500; ++i) {
    snapshots.apply(apart(i));
  }
  go_on = false;
  for (std::thread& reader : readers) {
    reader.join();
  }
}

TEST(FiberSnapshots, RefuseAnUnknownEngineAtOnce) {
  EXPECT_THROW(FiberSnapshots("octopus"), std::invalid_argument);
}

}  // namespace
}  // namespace fiber::test
