#include "fiber_proximity/environment/world.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>

#include "test/support/error_of.hpp"

namespace fiber::test {
namespace {

using Operation = ObjectChange::Operation;

EnvironmentObject ball(const std::string& name, double x) {
  EnvironmentObject object{name, Eigen::Isometry3d::Identity(), {{SphereShape{0.5}}}};
  object.pose.translation().x() = x;
  return object;
}

EnvironmentObject place(const std::string& name, double x) {
  EnvironmentObject object = ball(name, x);
  object.shapes.clear();
  return object;
}

const EnvironmentObject& only(const World& world) { return world.environment()->objects().at(0); }

std::string refusal(World& world, const std::vector<ObjectChange>& changes) {
  return error_of([&] { world.apply(changes); });
}

TEST(World, AppliesChanges) {
  World world;
  EXPECT_TRUE(world.environment()->objects().empty());
  world.apply({{Operation::ADD, ball("ball", 1.0)}});
  EXPECT_TRUE(world.has("ball"));
  world.apply({{Operation::APPEND, ball("ball", 2.0)}});
  EXPECT_EQ(only(world).shapes.size(), 2U);
  EXPECT_EQ(only(world).pose.translation().x(), 1.0);
  world.apply({{Operation::MOVE, place("ball", 3.0)}});
  EXPECT_EQ(only(world).pose.translation().x(), 3.0);
  EXPECT_EQ(only(world).shapes.size(), 2U);
  world.apply({{Operation::ADD, ball("ball", 4.0)}});
  EXPECT_EQ(only(world).shapes.size(), 1U);
  world.apply({{Operation::REMOVE, place("ball", 0.0)}});
  EXPECT_EQ(world.object_count(), 0U);
  world.apply({{Operation::APPEND, ball("ball", 5.0)}});
  EXPECT_EQ(only(world).pose.translation().x(), 5.0);
}

TEST(World, AppliesAllOrNothing) {
  World world;
  world.apply({{Operation::ADD, ball("ball", 1.0)}});
  const std::shared_ptr<const Environment> before = world.environment();
  EXPECT_EQ(refusal(world, {{Operation::ADD, ball("other", 1.0)},
                            {Operation::REMOVE, place("ball", 0.0)},
                            {Operation::MOVE, place("ball", 2.0)}}),
            "object 'ball': there is no object of this name to move or to remove");
  EXPECT_EQ(world.environment(), before);
  EXPECT_TRUE(world.has("ball"));
  EXPECT_FALSE(world.has("other"));
  EXPECT_NE(refusal(world, {{Operation::MOVE, ball("ball", 1.0)}}).find("comes with shapes"),
            std::string::npos);
  EXPECT_NE(refusal(world, {{Operation::ADD, place("empty", 1.0)}}).find("'empty'"),
            std::string::npos);
  EXPECT_NE(refusal(world, {{Operation::ADD, ball("", 1.0)}}).find("no name"), std::string::npos);
  EXPECT_EQ(world.object_count(), 1U);
}

/// What is asked goes on with the world as it was, whatever happens meanwhile.
TEST(World, AnswersFromTheMomentItWasAskedFor) {
  World world;
  world.apply({{Operation::ADD, ball("ball", 1.0)}});
  const FiberAssembly fibers({{0, -1, 0}, {0, 1, 0}}, {0, 2}, {0.25});
  QueryOptions options;
  options.margin = 1e3;
  std::atomic<bool> go_on{true};
  std::thread mover([&] {
    for (int i = 0; go_on; ++i) {
      world.apply({{Operation::MOVE, place("ball", 1.0 + i % 2)}});
    }
  });
  const auto ask = [&] {
    for (int i = 0; i < 200; ++i) {
      const std::shared_ptr<const Environment> environment = world.environment();
      const double x = environment->objects()[0].pose.translation().x();
      QueryResult result;
      environment->query(fibers, options, {}, result);
      ASSERT_EQ(result.contacts.size(), 1U);
      ASSERT_NEAR(result.contacts[0].distance, x - 0.75, 1e-12);
    }
  };
  std::thread asker(ask);
  ask();
  asker.join();
  go_on = false;
  mover.join();
}

}  // namespace
}  // namespace fiber::test
