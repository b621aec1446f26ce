// The running node without a fixed frame: asked before there are any fibres, with deadlines, and
// while it builds a mesh. The tests run in this order.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <random>
#include <set>

#include "fiber_proximity/AllowPairs.h"
#include "fiber_proximity/ApplyObstacles.h"
#include "fiber_proximity/CheckFibers.h"
#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/QueryProximity.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::AllowPairs;
using fiber_proximity::ApplyObstacles;
using fiber_proximity::CheckFibers;
using fiber_proximity::Contact;
using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using fiber_proximity::Obstacle;
using fiber_proximity::ObstacleArray;
using fiber_proximity::QueryProximity;
using test_messages::ball;
using test_messages::header;

constexpr double infinity = std::numeric_limits<double>::infinity();

Obstacle obstacle(const std::string& id) {
  Obstacle obstacle;
  obstacle.header.frame_id = "world";
  obstacle.id = id;
  obstacle.operation = Obstacle::ADD;
  return obstacle;
}

fiber_proximity::QueryShape shape(const Eigen::Vector3d& point, const std::string& frame) {
  fiber_proximity::QueryShape shape;
  shape.header.frame_id = frame;
  shape.points = {fiber_proximity_ros::to_message(point)};
  shape.radius = 0.01;
  return shape;
}

template <class Service>
typename Service::Response call(const std::string& name, const typename Service::Request& request) {
  Service service;
  service.request = request;
  EXPECT_TRUE(node_test::call_service("/proximity/" + name, service));
  return service.response;
}

class EnvironmentServicesTest : public node_test::NodeTest {
 protected:
  static void apply(const std::vector<Obstacle>& obstacles) {
    ApplyObstacles::Request request;
    request.obstacles = obstacles;
    const auto response = call<ApplyObstacles>("apply_obstacles", request);
    EXPECT_TRUE(response.success) << response.message;
  }

  static QueryProximity::Response query(const QueryProximity::Request& request) {
    return call<QueryProximity>("query", request);
  }

  /// A fibre along y at x, from the first y to the second.
  static FiberArray fiber(double x, double begin, double end) {
    FiberArray fiber = test_messages::fiber_array(
        header("world"), {{x, begin, 0.0}, {x, 0.5 * (begin + end), 0.0}, {x, end, 0.0}});
    fiber.radii = {0.01};
    fiber.names = {"fiber"};
    return fiber;
  }
};

TEST_F(EnvironmentServicesTest, WithoutFibresTheEnvironmentIsAskedAboutAllTheSame) {
  QueryProximity::Request request;
  request.against = QueryProximity::Request::ENVIRONMENT;
  request.type = QueryProximity::Request::CLOSEST;
  request.margin = infinity;
  // No frame is known yet: only shapes that name one cannot be placed.
  request.shapes = {shape({1, 0, 0}, "")};
  QueryProximity::Response answer = query(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_TRUE(answer.complete);
  EXPECT_EQ(answer.offsets, (std::vector<std::uint32_t>{0, 0}));
  EXPECT_EQ(answer.minimum_lower, std::vector<double>{infinity});
  request.shapes = {shape({1, 0, 0}, "world")};
  answer = query(request);
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find("shape 0: no transform from frame 'world': there is no fixed frame "
                                "yet, set the parameter fixed_frame"),
            std::string::npos)
      << answer.message;

  apply({ball("ball", 0.0, 0.25)});  // its frame is the fixed one from now on
  answer = query(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.header.frame_id, "world");
  EXPECT_FALSE(answer.header.stamp.isZero());
  EXPECT_TRUE(answer.fiber_names.empty());
  EXPECT_EQ(answer.object_names, std::vector<std::string>{"ball"});
  ASSERT_EQ(answer.contacts.size(), 1U);
  EXPECT_NEAR(answer.contacts[0].distance, 0.74, 1e-12);

  // What is asked about fibres is refused still.
  for (const auto against :
       {QueryProximity::Request::FIBERS, QueryProximity::Request::EVERYTHING}) {
    request.against = against;
    answer = query(request);
    EXPECT_FALSE(answer.success);
    EXPECT_NE(answer.message.find("no fresh input"), std::string::npos) << answer.message;
  }
}

TEST_F(EnvironmentServicesTest, WithoutFibresCandidatesAreCheckedThatAreToIgnoreThem) {
  apply({ball("ball", 0.0, 0.25)});
  CheckFibers::Request request;
  request.type = CheckFibers::Request::ALL;
  request.candidates = {fiber(0.2, -1, 1), fiber(0.3, -1, 1)};
  request.replaced_fibers = {"none of them"};
  EXPECT_FALSE(call<CheckFibers>("check_fibers", request).success);
  request.ignore_fibers = true;
  const auto answer = call<CheckFibers>("check_fibers", request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.free, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(answer.complete, (std::vector<std::uint8_t>{1, 1}));
  ASSERT_GE(answer.contacts.size(), 1U);
  EXPECT_EQ(answer.contacts[0].type_b, Contact::OBJECT);
}

TEST_F(EnvironmentServicesTest, ADeadlineIsThatOfTheWholeBatch) {
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, fiber(0.4, -1, 1));
  apply({ball("ball", 0.0, 0.25)});
  std::mt19937 random(16);
  std::uniform_real_distribution<double> coordinate(-1.0, 1.0);
  QueryProximity::Request request;
  request.type = QueryProximity::Request::CLOSEST;
  request.margin = infinity;
  for (int i = 0; i < 3000; ++i) {
    request.shapes.push_back(
        shape({coordinate(random), coordinate(random), coordinate(random)}, "world"));
  }
  for (const auto against : {QueryProximity::Request::FIBERS, QueryProximity::Request::ENVIRONMENT,
                             QueryProximity::Request::EVERYTHING}) {
    request.against = against;
    request.deadline = 0.0;
    const QueryProximity::Response truth = query(request);
    ASSERT_TRUE(truth.success) << truth.message;
    EXPECT_TRUE(truth.complete);
    ASSERT_EQ(truth.contacts.size(), request.shapes.size());
    for (const double deadline : {1e-9, 1e-4, 1e-3}) {
      request.deadline = deadline;
      const QueryProximity::Response answer = query(request);
      ASSERT_TRUE(answer.success) << answer.message;
      ASSERT_EQ(answer.offsets.size(), request.shapes.size() + 1);
      ASSERT_EQ(answer.minimum_lower.size(), request.shapes.size());
      EXPECT_EQ(answer.offsets.back(), answer.contacts.size());
      std::size_t unknown = 0;
      for (std::size_t i = 0; i < request.shapes.size(); ++i) {
        EXPECT_LE(answer.minimum_lower[i], truth.contacts[i].upper);
        if (answer.offsets[i + 1] == answer.offsets[i]) {
          EXPECT_EQ(answer.minimum_lower[i], -infinity);
          ++unknown;
        } else {
          EXPECT_EQ(answer.contacts[answer.offsets[i]].fiber_a, i);
          EXPECT_GE(answer.contacts[answer.offsets[i]].upper, truth.contacts[i].lower);
        }
      }
      EXPECT_TRUE(!answer.complete || unknown == 0);
      if (deadline == 1e-9) {
        EXPECT_FALSE(answer.complete);
        EXPECT_EQ(unknown, request.shapes.size());
      }
    }
  }
}

TEST_F(EnvironmentServicesTest, ShapesTheDeadlineComesBeforeAreNotRead) {
  apply({ball("ball", 0.0, 0.25)});
  QueryProximity::Request request;
  request.against = QueryProximity::Request::ENVIRONMENT;
  request.type = QueryProximity::Request::CLOSEST;
  request.margin = infinity;
  // No machine reads a million points in a millisecond, and the one after it cannot be read.
  request.shapes = {shape({1, 0, 0}, "world"), shape({1, 0, 0}, "world")};
  request.shapes[0].points.resize(1'000'000);
  request.shapes[1].points.clear();
  const QueryProximity::Response refusal = query(request);
  EXPECT_FALSE(refusal.success);
  EXPECT_NE(refusal.message.find("shape 1: has no points"), std::string::npos) << refusal.message;

  request.deadline = 1e-3;
  const QueryProximity::Response answer = query(request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_FALSE(answer.complete);
  EXPECT_EQ(answer.offsets.back(), answer.contacts.size());
  ASSERT_EQ(answer.minimum_lower.size(), 2U);
  EXPECT_EQ(answer.minimum_lower[1], -infinity);

  // Nor is there time to look for what is near the first one, once that is read.
  request.shapes.pop_back();
  EXPECT_FALSE(query(request).complete);
  request.deadline = 0.0;
  EXPECT_TRUE(query(request).complete);
}

TEST_F(EnvironmentServicesTest, ADeadlineIsThatOfAllCandidates) {
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, fiber(0.4, -1, 1));
  apply({ball("ball", 0.0, 0.25)});
  CheckFibers::Request request;
  request.type = CheckFibers::Request::ALL;
  for (int i = 0; i < 2000; ++i) {
    request.candidates.push_back(fiber(0.001 * i, -1, 1));
  }
  const auto truth = call<CheckFibers>("check_fibers", request);
  ASSERT_TRUE(truth.success) << truth.message;
  EXPECT_EQ(std::count(truth.complete.begin(), truth.complete.end(), 1), 2000);
  for (const double deadline : {1e-9, 1e-4, 1e-3}) {
    request.deadline = deadline;
    const auto answer = call<CheckFibers>("check_fibers", request);
    ASSERT_TRUE(answer.success) << answer.message;
    ASSERT_EQ(answer.free.size(), 2000U);
    ASSERT_EQ(answer.complete.size(), 2000U);
    ASSERT_EQ(answer.offsets.size(), 2001U);
    EXPECT_EQ(answer.offsets.back(), answer.contacts.size());
    for (std::size_t i = 0; i < 2000; ++i) {
      EXPECT_TRUE(answer.free[i] || !truth.free[i]) << i;
      EXPECT_TRUE(!answer.complete[i] || answer.free[i] == truth.free[i]) << i;
    }
    if (deadline == 1e-9) {
      EXPECT_EQ(std::count(answer.complete.begin(), answer.complete.end(), 0), 2000);
    }
  }
}

/// Along y at x, two metres long.
FiberArray fiber_of(std::size_t points, double x) {
  test_messages::Points along_y;
  for (std::size_t i = 0; i < points; ++i) {
    along_y.emplace_back(x, 2.0 * static_cast<double>(i) / static_cast<double>(points - 1), 0.0);
  }
  FiberArray fiber = test_messages::fiber_array(header("world"), along_y);
  fiber.radii = {0.001};
  fiber.names = {"fiber"};
  return fiber;
}

// Blocks are checked one after another. FIRST looks for contacts until the time is up; other types
// keep some of it to write them down, and may end while there is time for the next block.
TEST_F(EnvironmentServicesTest, AfterTheDeadlineNoBlockOfCandidatesIsChecked) {
  constexpr std::size_t count = 2000;
  constexpr std::size_t block = 256;
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, fiber(0.4, -1, 1));
  apply({ball("ball", 0.0, 0.25)});
  CheckFibers::Request request;
  request.type = CheckFibers::Request::FIRST;
  for (std::size_t i = 0; i < count; ++i) {
    request.candidates.push_back(fiber_of(400, 1.0 + 0.001 * static_cast<double>(i)));
  }
  std::size_t complete = 0;
  for (double deadline = 0.25e-3; complete < count && deadline < node_test::patience;
       deadline *= 2.0) {
    SCOPED_TRACE(deadline);
    request.deadline = deadline;
    const auto answer = call<CheckFibers>("check_fibers", request);
    ASSERT_TRUE(answer.success) << answer.message;
    ASSERT_EQ(answer.complete.size(), count);
    EXPECT_EQ(answer.free, std::vector<std::uint8_t>(count, 1));
    complete =
        static_cast<std::size_t>(std::count(answer.complete.begin(), answer.complete.end(), 1));
    const auto first = std::find(answer.complete.begin(), answer.complete.end(), 0);
    const auto blocks = static_cast<std::size_t>(first - answer.complete.begin()) / block;
    const std::size_t next = std::min((blocks + 1) * block, count);
    EXPECT_EQ(std::count(answer.complete.begin() + next, answer.complete.end(), 1), 0)
        << "candidate " << first - answer.complete.begin() << " is not complete";
  }
  EXPECT_EQ(complete, count);
}

TEST_F(EnvironmentServicesTest, CandidatesTheDeadlineComesBeforeAreNotRead) {
  CheckFibers::Request request;
  request.ignore_self = true;
  request.ignore_fibers = true;
  request.ignore_environment = true;
  // No machine reads a million points in a millisecond. Those after it cannot be read: one of the
  // same block, and one of another.
  request.candidates = {fiber_of(1'000'000, 1.0), fiber_of(2, 1.0), fiber_of(2, 1.0)};
  request.candidates[1].radii.clear();
  request.candidates[2].radii.clear();
  request.candidates[2].names = {"other"};
  const auto refusal = call<CheckFibers>("check_fibers", request);
  EXPECT_FALSE(refusal.success);
  EXPECT_NE(refusal.message.find("candidate 1: has no radii"), std::string::npos)
      << refusal.message;

  request.deadline = 1e-3;
  const auto answer = call<CheckFibers>("check_fibers", request);
  ASSERT_TRUE(answer.success) << answer.message;
  EXPECT_EQ(answer.complete, (std::vector<std::uint8_t>{0, 0, 0}));
  EXPECT_EQ(answer.free, (std::vector<std::uint8_t>{1, 1, 1}));
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
  const auto input = [&] { return input_of(*statistics.messages.back(), "obstacles"); };
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
