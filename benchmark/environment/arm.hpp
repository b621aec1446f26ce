#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace fiber {

/// A link of a robot's arm: a capsule along z.
struct ArmLink {
  const char* name;
  double radius;  ///< [m]
  double length;  ///< [m]
};

constexpr std::size_t arm_link_count = 8;

/// From the base to the gripper; about as large as those of a UR5.
const std::array<ArmLink, arm_link_count>& arm_links();

/// Where the links' centres are in the base's frame, whose z axis points up: the arm sweeps from
/// side to side over what is before it and up and down, once in a period.
/// @param periods since the beginning
std::array<Eigen::Isometry3d, arm_link_count> arm_poses(double periods);

}  // namespace fiber
