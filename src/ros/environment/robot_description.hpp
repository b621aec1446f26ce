#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "src/ros/environment/mesh_loader.hpp"

namespace fiber_proximity_ros {

/// A link of a robot that has collision geometry.
struct RobotLink {
  std::string frame;                ///< of tf
  fiber::EnvironmentObject object;  ///< named robot/LINK, in the link's frame
};

/// The links of a robot with collision geometry, in the order of their names; what is only to be
/// seen is not read.
/// @param description URDF
/// @throws std::invalid_argument for what is no URDF, and naming the link whose geometry is bad
std::vector<RobotLink> read_robot(const std::string& description, const MeshLoader& meshes);

}  // namespace fiber_proximity_ros
