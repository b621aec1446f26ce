#include "src/ros/player/fiber_player.hpp"

#include <ros/console.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/io/fiber_file.hpp"
#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::FiberAssembly;

/// The frame as it is played.
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
  std::vector<FiberAssembly> frames;
  frames.reserve(file.frames.size());
  for (fiber::FiberFrame& frame : file.frames) {
    const std::string where = options.file + (file.has_frames ? ", frame " : "") +
                              (file.has_frames ? std::to_string(frame.frame) : "");
    frames.push_back(select(std::move(frame.fibers), options, where));
  }
  if (frames.empty()) {
    throw std::invalid_argument(options.file + " has no frames");
  }
  return frames;
}

}  // namespace

PlayerOptions read_player_options(const ros::NodeHandle& private_node) {
  PlayerOptions options;
  const char* const text = "a string";
  read_parameter(private_node, "file", text, options.file);
  read_parameter(private_node, "scene", text, options.scene);
  read_parameter(private_node, "topic", text, options.topic);
  read_parameter(private_node, "format", text, options.format);
  read_parameter(private_node, "frame_id", text, options.frame_id);
  read_parameter(private_node, "loop", "true or false", options.loop);
  read_parameter(private_node, "fiber", -1, options.fiber);
  read_parameter(private_node, "rate", Limits{1e-3, 1e6}, options.rate);
  read_parameter(private_node, "start_delay", Limits{0.0, 1e9}, options.start_delay);
  read_parameter(private_node, "radius", Limits{0.0, FiberAssembly::max_coordinate},
                 options.radius);
  warn_of_unknown_parameters(private_node, {"file", "scene", "topic", "format", "frame_id", "loop",
                                            "fiber", "rate", "start_delay", "radius"});
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
