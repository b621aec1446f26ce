#include "src/ros/inputs/fiber_formats.hpp"

#include <geometry_msgs/PoseArray.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <visualization_msgs/MarkerArray.h>

#include <stdexcept>

#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::FiberAssembly;

geometry_msgs::Pose pose_of_point(const Eigen::Vector3d& point) {
  geometry_msgs::Pose pose;
  pose.position = to_message(point);
  pose.orientation.w = 1.0;
  return pose;
}

void fill(const std_msgs::Header& header, const FiberAssembly& fibers,
          fiber_proximity::FiberArray& message) {
  message.header = header;
  to_message(fibers, {}, message);
}

void fill(const std_msgs::Header& header, const FiberAssembly& fibers,
          sensor_msgs::PointCloud2& message) {
  message.header = header;
  sensor_msgs::PointCloud2Modifier modifier(message);
  modifier.setPointCloud2FieldsByString(1, "xyz");
  modifier.resize(fibers.point_count());
  sensor_msgs::PointCloud2Iterator<float> xyz(message, "x");
  for (const Eigen::Vector3d& point : fibers.points()) {
    for (int axis = 0; axis < 3; ++axis) {
      xyz[axis] = static_cast<float>(point[axis]);
    }
    ++xyz;
  }
}

void fill(const std_msgs::Header& header, const FiberAssembly& fibers,
          sensor_msgs::PointCloud& message) {
  message.header = header;
  message.points.clear();
  for (const Eigen::Vector3d& point : fibers.points()) {
    geometry_msgs::Point32 rounded;
    rounded.x = static_cast<float>(point.x());
    rounded.y = static_cast<float>(point.y());
    rounded.z = static_cast<float>(point.z());
    message.points.push_back(rounded);
  }
}

void fill(const std_msgs::Header& header, const FiberAssembly& fibers,
          geometry_msgs::PoseArray& message) {
  message.header = header;
  message.poses.clear();
  for (const Eigen::Vector3d& point : fibers.points()) {
    message.poses.push_back(pose_of_point(point));
  }
}

void fill(const std_msgs::Header& header, const FiberAssembly& fibers, nav_msgs::Path& message) {
  message.header = header;
  message.poses.clear();
  for (const Eigen::Vector3d& point : fibers.points()) {
    message.poses.emplace_back();
    message.poses.back().header = header;
    message.poses.back().pose = pose_of_point(point);
  }
}

void fill_strip(const std_msgs::Header& header, const FiberAssembly& fibers, std::uint32_t fiber,
                visualization_msgs::Marker& message) {
  const std::uint32_t begin = fibers.offsets()[fiber];
  message.header = header;
  message.ns = "fibers";
  message.id = static_cast<std::int32_t>(fiber);
  message.type = visualization_msgs::Marker::LINE_STRIP;
  message.pose.orientation.w = 1.0;
  message.scale.x = 2.0 * fibers.segment_radius(begin);
  message.color.r = message.color.g = message.color.b = message.color.a = 1.0F;
  message.points.clear();
  for (std::uint32_t i = begin; i < fibers.offsets()[fiber + 1]; ++i) {
    message.points.push_back(to_message(fibers.points()[i]));
  }
}

void fill(const std_msgs::Header& header, const FiberAssembly& fibers,
          visualization_msgs::Marker& message) {
  fill_strip(header, fibers, 0, message);
}

void fill(const std_msgs::Header& header, const FiberAssembly& fibers,
          visualization_msgs::MarkerArray& message) {
  message.markers.resize(fibers.fiber_count());
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    fill_strip(header, fibers, fiber, message.markers[fiber]);
  }
}

template <class Message>
FiberFormat::Publish advertise(ros::NodeHandle& node, const std::string& topic) {
  // The queue holds a second's worth of a usual tracker: a listener that is slow to connect or to
  // read gets every frame of a short recording.
  constexpr std::uint32_t waiting_messages = 30;
  return [publisher = node.advertise<Message>(topic, waiting_messages), message = Message()](
             const std_msgs::Header& header, const FiberAssembly& fibers) mutable {
    fill(header, fibers, message);
    publisher.publish(message);
  };
}

}  // namespace

const std::vector<FiberFormat>& fiber_formats() {
  static const std::vector<FiberFormat> formats{
      {"fiber_array", false, advertise<fiber_proximity::FiberArray>},
      {"marker_array", false, advertise<visualization_msgs::MarkerArray>},
      {"marker", true, advertise<visualization_msgs::Marker>},
      {"point_cloud2", true, advertise<sensor_msgs::PointCloud2>},
      {"point_cloud", true, advertise<sensor_msgs::PointCloud>},
      {"pose_array", true, advertise<geometry_msgs::PoseArray>},
      {"path", true, advertise<nav_msgs::Path>},
  };
  return formats;
}

const FiberFormat& find_fiber_format(const std::string& name) {
  std::string known;
  for (const FiberFormat& format : fiber_formats()) {
    if (format.name == name) {
      return format;
    }
    known += (known.empty() ? "" : ", ") + format.name;
  }
  throw std::invalid_argument("unknown format '" + name + "', known are: " + known);
}

}  // namespace fiber_proximity_ros
