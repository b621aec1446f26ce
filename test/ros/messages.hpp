#pragma once

#include <geometry_msgs/PoseArray.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "test/support/assemblies.hpp"

/// Messages of every input type, as trackers make them.
namespace test_messages {

using Points = std::vector<Eigen::Vector3d>;

inline std_msgs::Header header(const std::string& frame, const ros::Time& stamp = ros::Time()) {
  std_msgs::Header header;
  header.frame_id = frame;
  header.stamp = stamp;
  return header;
}

/// Where a frame is in that of the header.
inline geometry_msgs::TransformStamped transform(const std_msgs::Header& header,
                                                 const std::string& frame,
                                                 const Eigen::Isometry3d& pose) {
  const geometry_msgs::Pose placed = fiber_proximity_ros::to_message(pose);
  geometry_msgs::TransformStamped transform;
  transform.header = header;
  transform.child_frame_id = frame;
  transform.transform.translation.x = placed.position.x;
  transform.transform.translation.y = placed.position.y;
  transform.transform.translation.z = placed.position.z;
  transform.transform.rotation = placed.orientation;
  return transform;
}

/// The same of one that is not turned, now in the world.
inline geometry_msgs::TransformStamped transform(const std::string& frame,
                                                 const Eigen::Vector3d& position) {
  return transform(header("world", ros::Time::now()), frame,
                   Eigen::Isometry3d(Eigen::Translation3d(position)));
}

inline fiber_proximity::FiberArray fiber_array(const std_msgs::Header& header,
                                               const Points& points) {
  fiber_proximity::FiberArray message;
  message.header = header;
  message.offsets = {0, static_cast<std::uint32_t>(points.size())};
  for (const Eigen::Vector3d& point : points) {
    message.points.push_back(fiber_proximity_ros::to_message(point));
  }
  return message;
}

/// Six fibres of the same length, for threading, tangled so that many pairs are contacts.
inline fiber_proximity::FiberArray tangled_fibers(fiber::test::Random& random) {
  fiber::test::AssemblyBuilder builder;
  for (int i = 0; i < 6; ++i) {
    builder.add_fiber(fiber::test::random_walk(random, 30, 0.1));
  }
  const fiber::FiberAssembly fibers = builder.build({0.01});
  fiber_proximity::FiberArray message = fiber_array(header("world"), fibers.points());
  message.offsets = fibers.offsets();
  return message;
}

inline sensor_msgs::PointCloud2 point_cloud2(const std_msgs::Header& header, const Points& points) {
  sensor_msgs::PointCloud2 message;
  message.header = header;
  sensor_msgs::PointCloud2Modifier modifier(message);
  modifier.setPointCloud2FieldsByString(2, "xyz", "rgb");
  modifier.resize(points.size());
  sensor_msgs::PointCloud2Iterator<float> xyz(message, "x");
  for (const Eigen::Vector3d& point : points) {
    for (int axis = 0; axis < 3; ++axis) {
      xyz[axis] = static_cast<float>(point[axis]);
    }
    ++xyz;
  }
  return message;
}

inline sensor_msgs::PointCloud point_cloud(const std_msgs::Header& header, const Points& points) {
  sensor_msgs::PointCloud message;
  message.header = header;
  for (const Eigen::Vector3d& point : points) {
    geometry_msgs::Point32 p;
    p.x = static_cast<float>(point.x());
    p.y = static_cast<float>(point.y());
    p.z = static_cast<float>(point.z());
    message.points.push_back(p);
  }
  return message;
}

inline geometry_msgs::PoseArray pose_array(const std_msgs::Header& header, const Points& points) {
  geometry_msgs::PoseArray message;
  message.header = header;
  for (const Eigen::Vector3d& point : points) {
    message.poses.emplace_back();
    message.poses.back().position = fiber_proximity_ros::to_message(point);
  }
  return message;
}

inline nav_msgs::Path path(const std_msgs::Header& header, const Points& points) {
  nav_msgs::Path message;
  message.header = header;
  for (const Eigen::Vector3d& point : points) {
    message.poses.emplace_back();
    message.poses.back().pose.position = fiber_proximity_ros::to_message(point);
  }
  return message;
}

inline visualization_msgs::Marker marker(const std_msgs::Header& header, std::int32_t type,
                                         const Points& points) {
  visualization_msgs::Marker message;
  message.header = header;
  message.ns = "cable";
  message.type = type;
  message.scale.x = 0.02;
  message.scale.y = 0.02;
  message.scale.z = 0.02;
  message.pose.orientation.w = 1.0;
  for (const Eigen::Vector3d& point : points) {
    message.points.push_back(fiber_proximity_ros::to_message(point));
  }
  return message;
}

/// As TrackDLO draws a cable: a sphere per node and a cylinder per segment, interleaved, each in a
/// namespace of its own.
inline visualization_msgs::MarkerArray spheres_and_cylinders(const std_msgs::Header& header,
                                                             const Points& points) {
  using visualization_msgs::Marker;
  visualization_msgs::MarkerArray message;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (const std::int32_t type : {Marker::SPHERE, Marker::CYLINDER}) {
      if (i == 0 && type == Marker::CYLINDER) {
        continue;
      }
      Marker part = marker(header, type, {});
      part.ns = (type == Marker::SPHERE ? "node_" : "line_") + std::to_string(i);
      part.id = static_cast<std::int32_t>(i);
      const Eigen::Vector3d centre =
          type == Marker::SPHERE ? points[i] : Eigen::Vector3d(0.5 * (points[i - 1] + points[i]));
      part.pose.position = fiber_proximity_ros::to_message(centre);
      message.markers.push_back(part);
    }
  }
  return message;
}

/// A sphere, at this place along x.
inline fiber_proximity::Obstacle ball(const std::string& id, double x, double radius,
                                      const std::string& frame = "world") {
  fiber_proximity::Obstacle obstacle;
  obstacle.header.frame_id = frame;
  obstacle.id = id;
  obstacle.operation = fiber_proximity::Obstacle::ADD;
  obstacle.pose.position.x = x;
  obstacle.pose.orientation.w = 1.0;
  obstacle.primitives.resize(1);
  obstacle.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  obstacle.primitives[0].dimensions = {radius};
  return obstacle;
}

}  // namespace test_messages
