// The running node under random messages and service calls, good and bad ones, for as long as
// ~seconds says: it answers on, its contacts are those of brute force, and its memory does not
// grow.
#include <ros/master.h>
#include <ros/network.h>
#include <xmlrpcpp/XmlRpcClient.h>

#include <fstream>
#include <iostream>
#include <set>

#include "fiber_proximity/AllowPairs.h"
#include "fiber_proximity/ApplyObstacles.h"
#include "fiber_proximity/CheckFibers.h"
#include "fiber_proximity/ObstacleArray.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/not_finite.hpp"

namespace {

using fiber_proximity::FiberArray;
using fiber_proximity::Obstacle;
using test_messages::header;
using test_messages::Points;
using visualization_msgs::Marker;

using fiber::test::infinity;
using fiber::test::nan;

int pid_of(const std::string& name) {
  XmlRpc::XmlRpcValue request;
  XmlRpc::XmlRpcValue response;
  XmlRpc::XmlRpcValue payload;
  request[0] = "soak_test";
  request[1] = name;
  std::string host;
  std::uint32_t port = 0;
  if (!ros::master::execute("lookupNode", request, response, payload, false) ||
      !ros::network::splitURI(payload, host, port)) {
    return -1;
  }
  XmlRpc::XmlRpcClient client(host.c_str(), static_cast<int>(port), "/");
  XmlRpc::XmlRpcValue caller;
  caller[0] = "soak_test";
  return client.execute("getPid", caller, response) && response.valid() && response.size() == 3
             ? static_cast<int>(response[2])
             : -1;
}

/// [MB] of memory that a process holds; 0 if there is none of this number.
double resident_megabytes(int pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0.0;
    if (word == "VmRSS:" && status >> kilobytes) {
      return kilobytes / 1024.0;
    }
  }
  return 0.0;
}

class SoakTest : public node_test::NodeTest {
 protected:
  bool chance(double probability) { return random.chance(probability); }

  /// Numbers that nobody should send.
  double bad_number() {
    const std::vector<double> all{nan, infinity, -infinity, 1e300, -1e300, 1e-310};
    return all[static_cast<std::size_t>(random.integer(0, static_cast<int>(all.size()) - 1))];
  }

  std_msgs::Header any_header() {
    return header(chance(0.8) ? "world" : chance(0.8) ? "camera" : "nowhere", new_stamp());
  }

  Points any_chain() {
    Points chain = fiber::test::random_walk(random, random.integer(1, 60), 0.05);
    if (chance(0.1)) {
      chain[static_cast<std::size_t>(random.integer(0, static_cast<int>(chain.size()) - 1))]
           [random.integer(0, 2)] = bad_number();
    }
    if (chance(0.05)) {
      chain.resize(static_cast<std::size_t>(random.integer(0, 1)));
    }
    return chain;
  }

  FiberArray any_fibers() {
    FiberArray message = test_messages::fiber_array(any_header(), any_chain());
    const auto points = static_cast<std::uint32_t>(message.points.size());
    if (points >= 4 && chance(0.5)) {
      message.offsets = {0, points / 2, points};
    }
    if (chance(0.3)) {
      message.radii.assign(message.offsets.size() - 1, random.uniform(0.0, 0.05));
    }
    if (chance(0.1)) {
      message.offsets[static_cast<std::size_t>(
          random.integer(0, static_cast<int>(message.offsets.size()) - 1))] =
          static_cast<std::uint32_t>(random.integer(-1, 100));
    }
    if (chance(0.1)) {
      message.radii.assign(static_cast<std::size_t>(random.integer(1, 5)), bad_number());
    }
    if (chance(0.1)) {
      message.names = {"cable", chance(0.5) ? "cable" : ""};
    }
    return message;
  }

  void send_any_message() {
    switch (random.integer(0, 6)) {
      case 0:
        return arrays_.publish(any_fibers());
      case 1: {
        auto message = test_messages::point_cloud2(any_header(), any_chain());
        if (chance(0.1)) {
          message.row_step += static_cast<std::uint32_t>(random.integer(-40, 40));
        }
        if (chance(0.1)) {
          message.fields[0].offset = static_cast<std::uint32_t>(random.integer(-1, 40));
        }
        if (chance(0.1)) {
          message.data.resize(static_cast<std::size_t>(random.integer(0, 100)));
        }
        return clouds2_.publish(message);
      }
      case 2:
        return clouds_.publish(test_messages::point_cloud(any_header(), any_chain()));
      case 3:
        return poses_.publish(test_messages::pose_array(any_header(), any_chain()));
      case 4: {
        auto message = test_messages::path(any_header(), any_chain());
        if (!message.poses.empty() && chance(0.1)) {
          message.poses.back().header.frame_id = "gripper";
        }
        return paths_.publish(message);
      }
      case 5: {
        Marker message = test_messages::marker(any_header(), random.integer(-1, 12), any_chain());
        message.action = chance(0.8) ? 0 : random.integer(-1, 4);
        return markers_.publish(message);
      }
      default:
        return marker_arrays_.publish(
            test_messages::spheres_and_cylinders(any_header(), any_chain()));
    }
  }

  Obstacle any_obstacle() {
    Obstacle obstacle;
    obstacle.header = any_header();
    obstacle.header.stamp = ros::Time();
    obstacle.id = chance(0.05) ? "" : "object" + std::to_string(random.integer(0, 20));
    obstacle.pose.position = fiber_proximity_ros::to_message(random.in_cube());
    obstacle.pose.orientation.w = chance(0.95) ? 1.0 : bad_number();
    obstacle.operation = static_cast<std::int8_t>(chance(0.7) ? 0 : random.integer(-1, 4));
    obstacle.primitives.resize(1);
    obstacle.primitives[0].type = static_cast<std::uint8_t>(random.integer(0, 5));
    obstacle.primitives[0].dimensions.assign(static_cast<std::size_t>(random.integer(1, 3)),
                                             chance(0.9) ? random.uniform(0.0, 0.3) : bad_number());
    if (chance(0.2)) {
      obstacle.meshes.resize(1);
      obstacle.meshes[0].triangles.resize(4);
      for (auto& triangle : obstacle.meshes[0].triangles) {
        for (std::uint32_t& index : triangle.vertex_indices) {
          index = static_cast<std::uint32_t>(random.integer(0, chance(0.9) ? 3 : 9));
        }
        obstacle.meshes[0].vertices.push_back(fiber_proximity_ros::to_message(random.in_cube(0.3)));
      }
    }
    return obstacle;
  }

  /// Whatever the node says to it, the call itself must succeed.
  template <class Service>
  void call(const std::string& name, Service& service) {
    ASSERT_TRUE(node_test::call_service("/proximity/" + name, service)) << name;
    EXPECT_EQ(service.response.success, service.response.message.empty())
        << name << ": " << service.response.message;
  }

  void call_any_service() {
    const double margin = chance(0.1) ? bad_number() : random.uniform(0.0, 0.3);
    const auto type = static_cast<std::uint8_t>(random.integer(0, chance(0.9) ? 4 : 9));
    switch (random.integer(0, 3)) {
      case 0: {
        fiber_proximity::QueryProximity query;
        query.request.against = static_cast<std::uint8_t>(random.integer(0, 3));
        query.request.type = type;
        query.request.margin = margin;
        query.request.max_contacts = static_cast<std::uint32_t>(random.integer(0, 9));
        query.request.shapes.resize(static_cast<std::size_t>(random.integer(0, 3)));
        for (fiber_proximity::QueryShape& shape : query.request.shapes) {
          shape.header = any_header();
          shape.header.stamp = ros::Time();
          shape.radius = chance(0.9) ? random.uniform(0.0, 0.2) : bad_number();
          for (const Eigen::Vector3d& point : any_chain()) {
            shape.points.push_back(fiber_proximity_ros::to_message(point));
          }
        }
        return call("query", query);
      }
      case 1: {
        fiber_proximity::CheckFibers check;
        check.request.type = type;
        check.request.margin = margin;
        check.request.max_contacts = static_cast<std::uint32_t>(random.integer(0, 9));
        for (int i = random.integer(0, 3); i > 0; --i) {
          check.request.candidates.push_back(any_fibers());
        }
        return call("check_fibers", check);
      }
      case 2: {
        fiber_proximity::ApplyObstacles apply;
        for (int i = random.integer(0, 3); i > 0; --i) {
          apply.request.obstacles.push_back(any_obstacle());
        }
        return call("apply_obstacles", apply);
      }
      default: {
        fiber_proximity::AllowPairs allow;
        allow.request.reset = chance(0.5);
        allow.request.allow.resize(1);
        allow.request.allow[0].object = "object" + std::to_string(random.integer(0, 20));
        allow.request.allow[0].segments.assign(static_cast<std::size_t>(random.integer(0, 3)),
                                               random.integer(-9, 9));
        return call("allow_pairs", allow);
      }
    }
  }

  /// The node answers about good fibres, with what brute force finds among all it has.
  void expect_answer() {
    FiberArray message = test_messages::tangled_fibers(random);
    message.header.stamp = new_stamp();
    probe_.publish(message);
    const FiberArray* merged = fibers.wait_for(message.header.stamp);
    const fiber_proximity::ContactArray* answer = contacts.wait_for(message.header.stamp);
    ASSERT_NE(merged, nullptr) << "the node does not answer";
    ASSERT_NE(answer, nullptr) << "the node does not answer";
    ASSERT_GE(merged->points.size(), message.points.size());
    node_test::expect_brute_force(*answer, *merged);
    contacts_seen_ += answer->contacts.size();
    fibers.messages.clear();
    contacts.messages.clear();
    statistics.messages.clear();
    logs.messages.clear();
    environment_.messages.clear();
  }

  fiber::test::Random random;
  ros::Publisher probe_ = advertise<FiberArray>("probe");
  ros::Publisher arrays_ = advertise<FiberArray>("fiber_array");
  ros::Publisher clouds2_ = advertise<sensor_msgs::PointCloud2>("point_cloud2");
  ros::Publisher clouds_ = advertise<sensor_msgs::PointCloud>("point_cloud");
  ros::Publisher poses_ = advertise<geometry_msgs::PoseArray>("pose_array");
  ros::Publisher paths_ = advertise<nav_msgs::Path>("path");
  ros::Publisher markers_ = advertise<Marker>("marker");
  ros::Publisher marker_arrays_ = advertise<visualization_msgs::MarkerArray>("marker_array");
  node_test::Recorder<fiber_proximity::ContactArray> environment_{
      node, "/proximity/environment_contacts"};
  std::size_t contacts_seen_ = 0;
};

TEST_F(SoakTest, TheNodeAnswersOnAndItsMemoryDoesNotGrow) {
  SCOPED_TRACE(fiber::test::seed_message());
  double seconds = 10.0;
  ros::NodeHandle("~").getParam("seconds", seconds);
  connect(probe_, test_messages::tangled_fibers(random));
  const int pid = pid_of("/proximity");
  ASSERT_GT(pid, 0);
  // It may grow while there is still something to see for the first time.
  double grown = 0.0;
  std::size_t rounds = 0;
  const ros::SteadyTime begin = ros::SteadyTime::now();
  for (double now = 0.0; now < seconds; now = (ros::SteadyTime::now() - begin).toSec()) {
    for (int i = random.integer(0, 10); i > 0; --i) {
      send_any_message();
    }
    if (chance(0.3)) {
      call_any_service();
    }
    expect_answer();
    ASSERT_FALSE(HasFailure()) << "round " << rounds;
    if (now > 0.25 * seconds && grown == 0.0) {
      grown = resident_megabytes(pid);
    }
    ++rounds;
  }
  const double at_the_end = resident_megabytes(pid);
  std::cout << rounds << " rounds, " << contacts_seen_ << " contacts, " << grown
            << " MB after a quarter of the time, " << at_the_end << " MB at the end\n";
  EXPECT_EQ(pid_of("/proximity"), pid);
  EXPECT_GT(at_the_end, 0.0);
  if (seconds >= 60.0) {
    EXPECT_LE(at_the_end, 1.1 * grown + 10.0);
  }
}

}  // namespace
