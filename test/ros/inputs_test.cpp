// Every type of input through the running node.
#include <algorithm>

#include "fiber_proximity/CrossingArray.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using test_messages::header;
using test_messages::Points;
using visualization_msgs::Marker;

class InputsTest : public node_test::NodeTest {};

/// Coordinates that single precision holds: whole numbers of a 32768th. (Rounding doubles to floats
/// and back would not do: gcc 12 vectorises that away.)
Points random_chain(fiber::test::Random& random, std::size_t size) {
  const auto step = [&random] { return random.integer(-4096, 4096) / 32768.0; };
  Points chain;
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  while (chain.size() < size) {
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] += step();
    }
    chain.push_back(point);
  }
  return chain;
}

Points segments(const Points& chain) {
  Points pairs;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    pairs.push_back(chain[i]);
    pairs.push_back(chain[i + 1]);
  }
  return pairs;
}

/// How many fibres start at this point.
std::ptrdiff_t count_starts(const fiber_proximity::FiberArray& message,
                            const Eigen::Vector3d& point) {
  return std::count_if(message.offsets.begin(), message.offsets.end() - 1,
                       [&](std::uint32_t offset) {
                         return fiber_proximity_ros::to_vector(message.points[offset]) == point;
                       });
}

TEST_F(InputsTest, EveryTypeGivesTheSameFibreAndContactsAreThoseOfBruteForce) {
  SCOPED_TRACE(fiber::test::seed_message());
  fiber::test::Random random;
  const ros::Publisher fiber_array = advertise<fiber_proximity::FiberArray>("fiber_array");
  const ros::Publisher cloud2 = advertise<sensor_msgs::PointCloud2>("point_cloud2");
  const ros::Publisher cloud = advertise<sensor_msgs::PointCloud>("point_cloud");
  const ros::Publisher poses = advertise<geometry_msgs::PoseArray>("pose_array");
  const ros::Publisher path = advertise<nav_msgs::Path>("path");
  const ros::Publisher marker = advertise<Marker>("marker");
  const ros::Publisher markers = advertise<visualization_msgs::MarkerArray>("marker_array");
  connect(fiber_array, test_messages::fiber_array(header("world"), random_chain(random, 3)));
  const std::vector<std::string> names{"fiber_array", "point_cloud2", "point_cloud", "pose_array",
                                       "path",        "line",         "marker_array"};
  for (std::size_t round = 0; round < 5; ++round) {
    const Points chain = random_chain(random, 10 + 5 * round);
    const std_msgs::Header world = header("world", new_stamp());
    cloud2.publish(test_messages::point_cloud2(world, chain));
    cloud.publish(test_messages::point_cloud(world, chain));
    poses.publish(test_messages::pose_array(world, chain));
    path.publish(test_messages::path(world, chain));
    marker.publish(test_messages::marker(world, Marker::LINE_LIST, segments(chain)));
    markers.publish(test_messages::spheres_and_cylinders(world, chain));
    // Messages that arrive apart are answered apart; the one sent last has an answer of its own.
    ASSERT_NE(fibers.wait_for([&](const fiber_proximity::FiberArray& message) {
      return message.header.stamp == world.stamp && count_starts(message, chain.front()) == 6;
    }),
              nullptr);
    const ros::Time stamp = new_stamp();
    fiber_array.publish(test_messages::fiber_array(header("world", stamp), chain));
    const fiber_proximity::FiberArray* merged = fibers.wait_for(stamp);
    const fiber_proximity::ContactArray* answer = contacts.wait_for(stamp);
    ASSERT_NE(merged, nullptr) << "round " << round;
    ASSERT_NE(answer, nullptr) << "round " << round;
    EXPECT_EQ(merged->header.frame_id, "world");
    for (std::size_t i = 0; i < merged->points.size(); ++i) {
      EXPECT_EQ(fiber_proximity_ros::to_vector(merged->points[i]), chain[i % chain.size()])
          << "fibre " << names[i / chain.size()] << ", point " << i % chain.size();
    }
    EXPECT_EQ(merged->radii, (std::vector<double>{0.01, 0.01, 0.01, 0.01, 0.01, 0.02, 0.01}));

    EXPECT_EQ(merged->names, names);
    EXPECT_EQ(answer->fiber_names, names);
    EXPECT_EQ(answer->margin, 0.03);
    EXPECT_GT(answer->contacts.size(), chain.size());
    node_test::expect_brute_force(*answer, *merged);
  }
}

TEST_F(InputsTest, AZeroStampStandsForTheTimeOfArrival) {
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fiber_array");
  connect(publisher, test_messages::fiber_array(header("world"), {{0, 0, 0}, {1, 0, 0}}));
  const std::size_t before = fibers.messages.size();
  for (int i = 1; i <= 3; ++i) {
    const ros::Time sent = ros::Time::now();
    const double x = 10.0 * i;
    publisher.publish(test_messages::fiber_array(header("world"), {{x, 0, 0}, {1, 0, 0}}));
    const auto* answer = fibers.wait_for([x](const fiber_proximity::FiberArray& message) {
      return !message.points.empty() && message.points[0].x == x;
    });
    ASSERT_NE(answer, nullptr);
    EXPECT_GE(answer->header.stamp, sent);
    EXPECT_LE(answer->header.stamp, ros::Time::now());
  }
  EXPECT_GE(fibers.messages.size(), before + 3);
}

TEST_F(InputsTest, NamesRadiiAndSeveralFibresOfAMessageAreKept) {
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fiber_array");
  fiber_proximity::FiberArray message = test_messages::fiber_array(
      header("world"), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}});
  connect(publisher, message);
  const auto is_first = [](const std::vector<std::string>& names, const std::string& a,
                           const std::string& b) {
    return names.size() >= 2 && names[0] == a && names[1] == b;
  };
  message.offsets = {0, 2, 5};
  message.header.stamp = new_stamp();
  publisher.publish(message);
  ASSERT_NE(fibers.wait_for([&](const fiber_proximity::FiberArray& m) {
    return is_first(m.names, "fiber_array/0", "fiber_array/1");
  }),
            nullptr);
  message.names = {"left", "right"};
  message.radii = {0.1, 0.1, 0.2, 0.3, 0.4};
  message.header.stamp = new_stamp();
  publisher.publish(message);
  const auto* answer = fibers.wait_for(
      [&](const fiber_proximity::FiberArray& m) { return is_first(m.names, "left", "right"); });
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(std::vector<double>(answer->radii.begin(), answer->radii.begin() + 5), message.radii);
}

// As with `rostopic echo` where messages are rare: here none comes any more.
TEST_F(InputsTest, WhoListensLateIsToldWhatThereIs) {
  const ros::Publisher publisher = advertise<fiber_proximity::FiberArray>("fiber_array");
  connect(publisher, test_messages::fiber_array(header("world"), {{0, 0, 0}, {1, 0, 0}}));
  const ros::Time stamp = contacts.messages.back()->header.stamp;
  const auto is_answer = [&stamp](const auto& message) { return message.header.stamp == stamp; };
  const node_test::Recorder<fiber_proximity::ContactArray> late_contacts(node,
                                                                         "/proximity/contacts");
  const node_test::Recorder<fiber_proximity::FiberArray> late_fibers(node, "/proximity/fibers");
  const node_test::Recorder<fiber_proximity::Statistics> late_statistics(node,
                                                                         "/proximity/statistics");
  const node_test::Recorder<fiber_proximity::CrossingArray> late_crossings(node,
                                                                           "/proximity/crossings");
  const node_test::Recorder<visualization_msgs::MarkerArray> late_markers(node,
                                                                          "/proximity/markers");
  EXPECT_NE(late_contacts.wait_for(is_answer), nullptr);
  EXPECT_NE(late_fibers.wait_for(is_answer), nullptr);
  EXPECT_NE(late_statistics.wait_for(is_answer), nullptr);
  EXPECT_NE(late_crossings.wait_for(is_answer), nullptr);
  EXPECT_NE(late_markers.wait_for([](const auto& message) { return !message.markers.empty(); }),
            nullptr);
}

}  // namespace
