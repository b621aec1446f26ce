#pragma once

#include <ros/node_handle.h>
#include <std_msgs/Header.h>

#include <cstdint>
#include <functional>
#include <string>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/scenes/scene.hpp"
#include "src/ros/support/clock_watch.hpp"

namespace fiber_proximity_ros {

/// The source and the format that the player plays; the node's private parameters of the same
/// names, whose defaults are in cfg/interface.yaml.
struct PlayerOptions {
  std::string file;   ///< fibre file to play; empty: the scene
  std::string scene;  ///< one of fiber::scene_names()
  int fiber{};        ///< index of the one fibre to play; -1: all

  std::string topic;

  /// `fiber_array`, `marker_array` or, for one fibre, `marker`, `point_cloud2`, `point_cloud`,
  /// `pose_array` or `path`. Only `fiber_array` tells the radius; a marker's width is the diameter
  /// of the fibre's first segment.
  std::string format;
  std::string frame_id;

  double rate{};         ///< [Hz] frames per second
  bool loop{};           ///< begin again after a file's last frame
  double start_delay{};  ///< [s] before the first frame
  double radius{};       ///< [m] of fibres in a file without radii
};

/// @throws std::invalid_argument naming the parameter, its value and what is allowed
PlayerOptions read_player_options(const ros::NodeHandle& private_node);

/// Stands in for a tracker: publishes the frames of a fibre file or a scene at a rate, stamped with
/// the time of publishing. A file without frames is published again and again.
class FiberPlayer {
 public:
  /// @throws fiber::FileError for a file that is missing or malformed
  /// @throws std::invalid_argument for an unknown scene or format, a fibre that is not there, or
  ///         several fibres in a format that carries one
  FiberPlayer(const ros::NodeHandle& node, const PlayerOptions& options);

 private:
  void publish_next();

  ros::NodeHandle node_;
  PlayerOptions options_;
  fiber::Scene frames_;
  std::uint32_t frame_count_ = 0;  // 0: endless
  std::uint32_t next_frame_ = 0;
  std::function<void(const std_msgs::Header&, const fiber::FiberAssembly&)> publish_;
  ros::Timer timer_;
  ros::Timer start_timer_;
  ClockWatch clock_;
  ros::SteadyTimer clock_timer_;
};

}  // namespace fiber_proximity_ros
