#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/ros/yaml_field.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber_proximity_ros {

/// A fibre of a scene, as it is when the simulation begins.
struct SimFiber {
  std::string name;
  std::string group;                    ///< name of the entry it comes from
  std::vector<Eigen::Vector3d> points;  ///< [m]
  double radius = 0.0;                  ///< [m]
  fiber::RodSection section;
};

/// Reads the list `fibers` of a scene: name, shape, segments, radius, material, repeat.
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed; the fibre
///         too where it is about its physics
std::vector<SimFiber> read_sim_fibers(const YamlField& list);

}  // namespace fiber_proximity_ros
