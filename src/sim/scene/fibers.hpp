#pragma once

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/description.hpp"
#include "src/text/quote.hpp"

namespace fiber {

/// A fibre of a scene before it is cut into segments, or several that are alike.
struct FiberEntry {
  std::string name;
  std::string place;                   ///< where it stands, for errors
  std::vector<Eigen::Vector3d> curve;  ///< a polyline [m]
  std::optional<std::int64_t> segments;
  double radius = 0.0;  ///< [m]
  RodSection section;
  std::optional<std::int64_t> count;  ///< none: it is not repeated
  std::string repeat_place;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of each from the one before [m]

  // Of the curve, where segments are chosen.
  double length = 0.0;   ///< [m]
  double turning = 0.0;  ///< in all [rad]

  /// Those given, or as many as an accuracy takes.
  /// @throws std::invalid_argument for more than a scene may have
  std::int64_t segments_for(std::optional<double> accuracy) const;
};

/// Reads the list `fibers` of a scene: name, shape, segments, radius, material, repeat.
/// @param chooses_segments whether entries may leave out their segments
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed; the fibre
///         too where it is about its physics
std::vector<FiberEntry> read_fibers(const YamlField& list, bool chooses_segments);

/// Cuts the fibres into segments: the rods of a scene, and what they are called.
/// @param accuracy by which segments are chosen that are not given
/// @throws std::invalid_argument naming file, line and fibre
void cut(const std::vector<FiberEntry>& entries, std::optional<double> accuracy,
         SimDescription& scene);

/// Runs a function; an error of its names the fibre, too, after what it says.
template <class Function>
auto naming_fiber(const std::string& name, const Function& function) {
  try {
    return function();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(error.what()) + " (fibre " + quote(name) + ")");
  }
}

}  // namespace fiber
