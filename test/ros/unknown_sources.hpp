#pragma once

#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/ObstacleArray.h"
#include "test/ros/messages.hpp"
#include "test/ros/simulated_time_test.hpp"

/// Sources of fibres and environment that fail, each in its ways: as in unknown.test.
namespace unknown_test {

using fiber_proximity::FiberArray;
using fiber_proximity::ObstacleArray;
using sensor_msgs::PointCloud2;
using test_messages::header;
using visualization_msgs::MarkerArray;

enum class Fault {
  NONE,
  SILENCE,       // never came, or stopped
  REFUSED,       // malformed
  UNKNOWN_TF,    // in a frame that nobody has heard of
  OLD_TF,        // tf does not go on to its stamp
  NOT_CONNECTED  // in a frame that tf knows nowhere near the fixed one
};

inline std::string name_of(Fault fault) {
  static const char* const names[] = {"none",       "silence", "refused",
                                      "unknown tf", "old tf",  "not connected"};
  return names[static_cast<int>(fault)];
}

/// The frame that a message of this fault is in.
inline std::string frame_of(Fault fault) {
  switch (fault) {
    case Fault::UNKNOWN_TF:
      return "nowhere";
    case Fault::OLD_TF:
      return "frozen";
    case Fault::NOT_CONNECTED:
      return "adrift";
    default:
      return "world";
  }
}

/// Where answers come from.
struct Source {
  std::string name;    // in what is unknown
  std::string status;  // on /diagnostics
  bool is_of_fibers;
  std::vector<Fault> faults;  // once it has been heard
  std::function<void(Fault)> send;
  Fault fault = Fault::SILENCE;
};

/// Sends what the sources have, as their faults are.
class FailingSources : public node_test::SimulatedTimeTest {
 protected:
  /// To be called when all is listened to that the sources bring about.
  void start() {
    a_ = advertise<FiberArray>("/a");
    b_ = advertise<FiberArray>("/b");
    cloud_ = advertise<PointCloud2>("/proximity/cloud");
    bodies_ = advertise<MarkerArray>("/bodies");
    obstacles_ = advertise<ObstacleArray>("/proximity/obstacles");
    geometry_msgs::TransformStamped frozen = transform("world", "frozen", now());
    transforms_.sendTransform(frozen);
    const std::vector<Fault> all{Fault::SILENCE, Fault::REFUSED, Fault::UNKNOWN_TF, Fault::OLD_TF,
                                 Fault::NOT_CONNECTED};
    // What was sent once stays: that a topic of obstacles falls silent is no fault.
    const std::vector<Fault> of_changes{Fault::REFUSED, Fault::UNKNOWN_TF, Fault::OLD_TF,
                                        Fault::NOT_CONNECTED};
    sources_ = {
        {"input /a", "input /a", true, all, [this](Fault fault) { send_fibers(a_, 0.0, fault); }},
        {"input /b", "input /b", true, all, [this](Fault fault) { send_fibers(b_, 1.0, fault); }},
        {"robot/tool",
         "environment robot",
         false,
         {Fault::SILENCE, Fault::OLD_TF, Fault::NOT_CONNECTED},
         [this](Fault fault) { send_link(fault); }},
        {"cloud", "environment /proximity/cloud", false, all,
         [this](Fault fault) { send_cloud(fault); }},
        {"bodies/0", "environment /bodies", false, of_changes,
         [this](Fault fault) { send_marker(fault); }},
        {"ball", "environment /proximity/obstacles", false, of_changes,
         [this](Fault fault) { send_obstacle(fault); }},
        {"shelf", "environment scene", false, {}, [this](Fault fault) { send_wall(fault); }},
    };
  }

  static geometry_msgs::TransformStamped transform(const std::string& parent,
                                                   const std::string& child,
                                                   const ros::Time& stamp) {
    return test_messages::transform(header(parent, stamp), child,
                                    Eigen::Isometry3d(Eigen::Translation3d(0.0, 5.0, 0.0)));
  }

  void send_fibers(const ros::Publisher& publisher, double x, Fault fault) {
    FiberArray message =
        test_messages::fiber_array(header(frame_of(fault), now()), {{x, 0, 0}, {x, 0, 1}});
    if (fault == Fault::REFUSED) {
      message.points[1].y = std::nan("");
    }
    publisher.publish(message);
  }

  void send_link(Fault fault) {
    const ros::Time stamp = fault == Fault::OLD_TF ? now() - ros::Duration(5.0) : now();
    transforms_.sendTransform(
        transform(fault == Fault::NOT_CONNECTED ? "raft" : "world", "tool", stamp));
  }

  void send_cloud(Fault fault) {
    PointCloud2 message = test_messages::point_cloud2(header(frame_of(fault), now()), {{0, 9, 0}});
    if (fault == Fault::REFUSED) {
      message.fields.clear();
    }
    cloud_.publish(message);
  }

  void send_marker(Fault fault) {
    using visualization_msgs::Marker;
    MarkerArray message;
    message.markers.push_back(
        test_messages::marker(header(frame_of(fault), now()), Marker::CUBE, {}));
    message.markers[0].ns = "bodies";
    message.markers[0].pose.position.y = -9.0;
    if (fault == Fault::REFUSED) {
      message.markers[0].scale.x = -1.0;
    }
    bodies_.publish(message);
  }

  void send_obstacle(Fault fault) {
    ObstacleArray message;
    message.obstacles.push_back(test_messages::ball("ball", -9.0, 0.1, frame_of(fault)));
    message.obstacles[0].header.stamp = now();
    if (fault == Fault::REFUSED) {
      message.obstacles[0].primitives[0].dimensions.clear();
    }
    obstacles_.publish(message);
  }

  void send_wall(Fault fault) {
    if (fault == Fault::NONE) {
      static_transforms_.sendTransform(transform("world", "wall", now()));
    }
  }

  /// All that is sent, as time goes on.
  void step() {
    transforms_.sendTransform(transform("raft", "adrift", now()));
    for (const Source& source : sources_) {
      if (source.fault != Fault::SILENCE) {
        source.send(source.fault);
      }
    }
    pass(0.05);
  }

  std::vector<Source> sources_;
  tf2_ros::TransformBroadcaster& transforms_ =
      node_test::broadcaster<tf2_ros::TransformBroadcaster>();
  tf2_ros::StaticTransformBroadcaster& static_transforms_ =
      node_test::broadcaster<tf2_ros::StaticTransformBroadcaster>();
  ros::Publisher a_;
  ros::Publisher b_;
  ros::Publisher cloud_;
  ros::Publisher bodies_;
  ros::Publisher obstacles_;
};

}  // namespace unknown_test
