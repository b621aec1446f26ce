#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/ros/yaml_field.hpp"
#include "fiber_proximity/sim/rods.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {

/// A fibre of a scene, as it is when the simulation begins.
struct SimFiber {
  std::string name;
  std::string group;                    ///< name of the entry it comes from
  std::string place;                    ///< where that stands, for errors
  std::vector<Eigen::Vector3d> points;  ///< [m]
  double radius = 0.0;                  ///< [m]
  fiber::RodSection section;
};

/// Reads the list `fibers` of a scene: name, shape, segments, radius, material, repeat.
/// @param accuracy by which segments are chosen that are not given (fiber::segments_for); none:
///                 they must be given
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed; the fibre
///         too where it is about its physics
std::vector<SimFiber> read_sim_fibers(const YamlField& list, std::optional<double> accuracy);

/// Runs a function; an error of its names the fibre, too, after what it says.
template <class Function>
auto naming_fiber(const std::string& name, const Function& function) {
  try {
    return function();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(error.what()) + " (fibre " + fiber::quote(name) + ")");
  }
}

}  // namespace fiber_proximity_ros
