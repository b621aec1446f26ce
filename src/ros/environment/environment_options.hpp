#pragma once

#include <ros/node_handle.h>

#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/ros/environment/cloud_cells.hpp"
#include "src/ros/environment/mesh_loader.hpp"
#include "src/ros/environment/robot_links.hpp"
#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {

/// A topic of markers that are obstacles.
struct MarkerTopic {
  std::string topic;
  bool is_array = true;  ///< visualization_msgs/MarkerArray, or Marker
  bool required = true;  ///< answers are incomplete until its first message
};

/// Where the environment comes from, as the private parameters have it; their defaults are in
/// cfg/interface.yaml.
struct EnvironmentOptions {
  MeshLoader meshes;
  fiber::EnvironmentScene scene;
  std::vector<RobotLink> robot;
  std::optional<CloudOptions> cloud;
  std::vector<MarkerTopic> marker_topics;

  bool obstacles_required{};  ///< answers are incomplete until the first message of ~obstacles

  double robot_timeout{};  ///< [s] links are unknown whose transforms are older

  double tf_timeout{};  ///< [s] of wall time a cloud may wait for its transform

  double max_stamp_ahead{};  ///< [s] a stamp may be ahead of the node's time

  /// [s] of wall time an obstacle may wait for its transform; longer than tf takes to arrive after
  /// the start, as nobody sends obstacles twice
  double obstacle_timeout{};
};

/// Reads the parameters, and with them scene and robot.
/// @throws std::invalid_argument for a bad one, naming it and what is allowed: a part of an
///         environment is none to rely on
EnvironmentOptions read_environment_options(const ros::NodeHandle& node,
                                            const ros::NodeHandle& private_node);

/// Reads ~mesh_folders.
/// @throws std::invalid_argument naming the parameter, or for a folder that is not there
MeshLoader read_mesh_folders(const Parameters& parameters);

}  // namespace fiber_proximity_ros
