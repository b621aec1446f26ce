// Fibres of a scene before and after they are cut into segments.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// A part of a fibre that has a section of its own.
struct SectionEntry {
  RodPart part;  ///< along the curve [m]
  RodSection section;
  std::optional<double> radius;  ///< [m] none: the fibre's
  bool is_rigid = false;
  std::string place;  ///< where it stands, for errors
};

/// A fibre of a scene before it is cut into segments, or several of them by `repeat`.
struct FiberEntry {
  std::string name;
  std::string place;                   ///< where it stands, for errors
  std::vector<Eigen::Vector3d> curve;  ///< a polyline [m]
  std::optional<std::int64_t> segments;
  double radius = 0.0;  ///< [m]
  RodSection section;
  std::vector<SectionEntry> sections;
  std::optional<std::int64_t> count;  ///< none: it is not repeated
  std::string repeat_place;
  bool is_closed = false;
  std::optional<SimStiffSide> stiff_side;
  std::vector<double> joint_shares;  ///< of its length, at which it has nodes; rising
  std::string material_defaults;     ///< values that its material leaves open; empty for none
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of each from the one before [m]

  double length = 0.0;    ///< of the curve [m]
  double turning = 0.0;   ///< of the curve in all [rad]; only known where segments are chosen
  double limpness = 0.0;  ///< see fiber::limpness(); the same

  /// To begin with, at equal distances along the fibre, in between straight lines [m/s]; empty: 0.
  std::vector<Eigen::Vector3d> velocities;
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< to begin with [rad/s]

  /// The segments given, or chosen for an accuracy.
  /// @throws std::invalid_argument naming the fibre, for more segments than a scene may have
  std::int64_t segments_for(std::optional<double> accuracy) const;
};

/// Reads the list `fibers` of a scene.
/// @param chooses_segments whether a fibre may leave its segments open
/// @throws std::invalid_argument naming file, line, field and value, what is allowed, and the fibre
std::vector<FiberEntry> read_fibers(const YamlField& list, bool chooses_segments);

/// Cuts the fibres into segments: the rods of a scene, and their names.
/// @param accuracy by which segments are chosen that are not given; none where all are given
/// @throws std::invalid_argument for more segments than a scene may have, and for two fibres of a
///         name
void cut_fibers(const std::vector<FiberEntry>& entries, std::optional<double> accuracy,
                SimDescription& scene);

}  // namespace fiber
