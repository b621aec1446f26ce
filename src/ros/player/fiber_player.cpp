#include "src/ros/player/fiber_player.hpp"

#include <geometry_msgs/PoseArray.h>
#include <nav_msgs/Path.h>
#include <ros/console.h>
#include <ros/names.h>
#include <sensor_msgs/PointCloud.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::FiberAssembly;
using Publish = std::function<void(const std_msgs::Header&, const FiberAssembly&)>;

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
  message.poses.resize(fibers.point_count());
  std::transform(fibers.points().begin(), fibers.points().end(), message.poses.begin(),
                 pose_of_point);
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
Publish advertise(ros::NodeHandle& node, const std::string& topic) {
  // The queue holds a second's worth of a usual tracker: a listener that is slow to connect or to
  // read gets every frame of a short recording.
  constexpr std::uint32_t waiting_messages = 30;
  return [publisher = node.advertise<Message>(topic, waiting_messages), message = Message()](
             const std_msgs::Header& header, const FiberAssembly& fibers) mutable {
    fill(header, fibers, message);
    publisher.publish(message);
  };
}

/// A message that fibres can travel in, as different trackers send them.
struct FiberFormat {
  std::string name;
  bool one_fiber;  // the message has room for a single one

  /// Advertises the topic and returns the function that publishes fibres there.
  Publish (*advertise)(ros::NodeHandle& node, const std::string& topic);
};

const FiberFormat& find_fiber_format(const std::string& name) {
  static const std::vector<FiberFormat> formats{
      {"fiber_array", false, advertise<fiber_proximity::FiberArray>},
      {"marker_array", false, advertise<visualization_msgs::MarkerArray>},
      {"marker", true, advertise<visualization_msgs::Marker>},
      {"point_cloud2", true, advertise<sensor_msgs::PointCloud2>},
      {"point_cloud", true, advertise<sensor_msgs::PointCloud>},
      {"pose_array", true, advertise<geometry_msgs::PoseArray>},
      {"path", true, advertise<nav_msgs::Path>},
  };
  return find_by_name(formats, "format", name);
}

/// Selects the fibres of a frame that are played.
FiberAssembly select(FiberAssembly fibers, const PlayerOptions& options, const std::string& where) {
  const std::string count = std::to_string(fibers.fiber_count());
  if (options.fiber < 0) {
    if (find_fiber_format(options.format).one_fiber && fibers.fiber_count() != 1) {
      throw std::invalid_argument(where + " has " + count + " fibres, format '" + options.format +
                                  "' carries one: choose it with the parameter 'fiber'");
    }
    return fibers;
  }
  const auto index = static_cast<std::uint32_t>(options.fiber);
  if (index >= fibers.fiber_count()) {
    throw std::invalid_argument("parameter fiber is " + std::to_string(options.fiber) + ", but " +
                                where + " has " + count + " fibre(s), numbered from 0");
  }
  return fiber::select_fibers(fibers, {index});
}

std::vector<FiberAssembly> read_frames(const PlayerOptions& options) {
  fiber::FiberFile file = fiber::read_fibers(options.file, options.radius);
  for (const std::string& note : file.notes) {
    ROS_WARN("%s: %s", options.file.c_str(), note.c_str());
  }
  std::vector<FiberAssembly> frames;
  frames.reserve(file.frames.size());
  for (fiber::FiberFrame& frame : file.frames) {
    const std::string where =
        options.file + (file.has_frames ? ", frame " + std::to_string(frame.frame) : "");
    frames.push_back(select(std::move(frame.fibers), options, where));
  }
  if (frames.empty()) {
    throw std::invalid_argument(options.file + " has no frames");
  }
  return frames;
}

}  // namespace

PlayerOptions read_player_options(const ros::NodeHandle& private_node) {
  const Parameters parameters(private_node, interface_of("fiber_player"));
  PlayerOptions options;
  parameters.read("file", options.file);
  parameters.read("scene", options.scene);
  parameters.read("topic", options.topic);
  parameters.read("format", options.format);
  parameters.read("frame_id", options.frame_id);
  parameters.read("loop", options.loop);
  parameters.read("fiber", options.fiber);
  parameters.read("rate", options.rate);
  parameters.read("start_delay", options.start_delay);
  parameters.read("radius", options.radius);
  parameters.warn_of_unknown();
  if (std::string reason; !ros::names::validate(options.topic, reason)) {
    parameters.refuse("topic", "a ROS name: " + reason);
  }
  if (options.frame_id.empty()) {
    parameters.refuse("frame_id", "the name of a frame: messages without one are refused");
  }
  if (!options.file.empty() && private_node.hasParam("scene")) {
    throw std::invalid_argument("parameters file and scene are both set: " + options.file +
                                " and " + options.scene);
  }
  return options;
}

FiberPlayer::FiberPlayer(const ros::NodeHandle& node, const PlayerOptions& options)
    : node_(node), options_(options) {
  const FiberFormat& format = find_fiber_format(options.format);
  if (options.file.empty()) {
    frames_ = [scene = fiber::make_scene(options.scene, {}), options](std::uint32_t frame) {
      return select(scene(frame), options, "scene '" + options.scene + "'");
    };
    frames_(0);  // what is wrong with the options shows here
  } else {
    auto frames = std::make_shared<const std::vector<FiberAssembly>>(read_frames(options));
    frame_count_ = static_cast<std::uint32_t>(frames->size());
    frames_ = [frames](std::uint32_t frame) { return (*frames)[frame]; };
  }
  publish_ = format.advertise(node_, options.topic);
  timer_ = node_.createTimer(
      ros::Duration(1.0 / options.rate), [this](const ros::TimerEvent&) { publish_next(); }, false,
      false);
  start_timer_ = node_.createTimer(
      ros::Duration(options.start_delay), [this](const ros::TimerEvent&) { timer_.start(); }, true);
  clock_timer_ = node_.createSteadyTimer(ros::WallDuration(1.0),
                                         [this](const ros::SteadyTimerEvent&) { clock_.look(); });
}

void FiberPlayer::publish_next() {
  std_msgs::Header header;
  header.stamp = ros::Time::now();
  header.frame_id = options_.frame_id;
  publish_(header, frames_(next_frame_++));
  if (next_frame_ != frame_count_) {
    return;
  }
  next_frame_ = 0;
  if (!options_.loop) {
    timer_.stop();
    ROS_INFO("played all %u frame(s) of %s", frame_count_, options_.file.c_str());
  }
}

}  // namespace fiber_proximity_ros
