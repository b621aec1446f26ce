// The running node while its environment changes: obstacles without a transform, a large mesh, many
// allowed pairs. The tests run in this order, after those of environment_services_test.cpp.
#include <chrono>
#include <cmath>
#include <future>
#include <random>
#include <set>

#include "fiber_proximity/AllowPairs.h"
#include "fiber_proximity/ObstacleArray.h"
#include "test/ros/environment_services_fixture.hpp"

namespace {

using fiber_proximity::AllowPairs;
using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using fiber_proximity::Obstacle;
using fiber_proximity::ObstacleArray;
using node_test::EnvironmentServicesTest;
using test_messages::ball;

Obstacle obstacle(const std::string& id) {
  Obstacle obstacle;
  obstacle.header.frame_id = "world";
  obstacle.id = id;
  obstacle.operation = Obstacle::ADD;
  return obstacle;
}

TEST_F(EnvironmentServicesTest, ABadObstacleBeforeEachOneOfAnotherDelaysNothing) {
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  node_test::Recorder<ContactArray> around(node, "/proximity/environment_contacts");
  connect(publisher, fiber(0.4, -1, 1), [&] { return !around.messages.empty(); });
  const ros::Publisher obstacles = advertise<ObstacleArray>("/proximity/obstacles");
  for (int i = 0; i < 5; ++i) {
    ObstacleArray message;
    message.obstacles = {ball("lost", 0.0, 0.25, "nowhere")};
    obstacles.publish(message);
    const double x = 2.0 + i;
    message.obstacles = {ball("ball", x, 0.25)};
    obstacles.publish(message);
    ASSERT_NE(around.wait_for([x](const ContactArray& found) {
      return std::abs(found.minimum_distance - (x - 0.4 - 0.25 - 0.01)) < 1e-9;
    }),
              nullptr)
        << i;
  }
  Obstacle all = obstacle("");
  all.operation = Obstacle::REMOVE;
  apply({all});  // those that wait, too
}

/// Triangles in no order.
Obstacle thicket(const std::string& id, std::uint32_t triangles) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  Obstacle thicket = obstacle(id);
  thicket.meshes.resize(1);
  for (std::uint32_t i = 0; i < triangles; ++i) {
    thicket.meshes[0].triangles.emplace_back();
    for (std::uint32_t corner = 0; corner < 3; ++corner) {
      thicket.meshes[0].triangles.back().vertex_indices[corner] = 3 * i + corner;
      thicket.meshes[0].vertices.push_back(fiber_proximity_ros::to_message(
          Eigen::Vector3d(coordinate(random), coordinate(random), 10.0)));
    }
  }
  return thicket;
}

// Building takes much longer than some frames, whatever else the machine does: what is asserted is
// their order.
TEST_F(EnvironmentServicesTest, ContactsKeepComingWhileALargeMeshIsBuilt) {
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  node_test::Recorder<ContactArray> around(node, "/proximity/environment_contacts");
  apply({ball("ball", 0.0, 0.25)});
  connect(publisher, fiber(0.4, -1, 1), [&] { return !around.messages.empty(); });
  const ros::Publisher obstacles = advertise<ObstacleArray>("/proximity/obstacles");
  const auto input = [&] { return input_of(*statistics.messages.back(), "/proximity/obstacles"); };
  ObstacleArray message;
  message.obstacles = {ball("other", 1.0, 0.25)};
  obstacles.publish(message);
  const std::uint64_t received = input()->received + 1;
  message.obstacles = {thicket("thicket", 300000)};
  obstacles.publish(message);
  // Answers between the arrival of the mesh and its being there.
  std::set<ros::Time> meanwhile;
  bool is_there = false;
  ASSERT_TRUE(node_test::wait_for([&] {
    FiberArray cable = fiber(0.4, -1, 1);
    cable.header.stamp = new_stamp();
    publisher.publish(cable);
    const ContactArray* answer = around.wait_for(cable.header.stamp);
    const auto* told = statistics.wait_for(cable.header.stamp);
    if (answer == nullptr || told == nullptr) {
      return true;
    }
    is_there = answer->object_names.size() == 3;
    if (!is_there && input()->received > received) {
      meanwhile.insert(cable.header.stamp);
    }
    return is_there;
  }));
  EXPECT_TRUE(is_there);
  EXPECT_GE(meanwhile.size(), 3U);
  EXPECT_EQ(around.messages.back()->object_names,
            (std::vector<std::string>{"ball", "other", "thicket"}));
}

// So many that a search through all of them for each would take many times our patience; it takes
// seconds.
TEST_F(EnvironmentServicesTest, ManyPairsAreAllowedAtOnceAndTakenBack) {
  constexpr std::int32_t count = 500'000;
  const auto answer_to = [](const AllowPairs::Request& request) {
    auto answer = std::async(std::launch::async, call<AllowPairs>, "allow_pairs", request);
    EXPECT_TRUE(node_test::wait_for([&answer] {
      return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
    })) << "there is no answer yet";
    return answer.get();
  };
  AllowPairs::Request request;
  request.reset = true;
  for (std::int32_t i = 0; i < count; ++i) {
    request.allow.emplace_back();
    request.allow.back().object = i % 2 == 0 ? "ball" : "object " + std::to_string(i);
    request.allow.back().fiber = "fiber";
    request.allow.back().segments = {i, i + 1};
  }
  auto answer = answer_to(request);
  ASSERT_TRUE(answer.success) << answer.message;
  ASSERT_EQ(answer.allowed.size(), static_cast<std::size_t>(count));
  EXPECT_EQ(answer.allowed[123'457].object, "object 123457");
  request.reset = false;
  request.forbid.assign(request.allow.begin() + 1, request.allow.end());
  request.allow = {request.allow[0]};
  answer = answer_to(request);
  ASSERT_TRUE(answer.success) << answer.message;
  ASSERT_EQ(answer.allowed.size(), 1U);
  EXPECT_EQ(answer.allowed[0].object, "ball");
}

}  // namespace
