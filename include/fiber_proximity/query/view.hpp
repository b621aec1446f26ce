#pragma once

#include <Eigen/Core>

namespace fiber {

/// How fibres are looked at.
struct View {
  /// Along which the viewer looks, of any length but 0: from above by default. What is further
  /// along it is further away.
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();

  /// Whether the rays of sight start in the eye, as a camera's; else all are parallel to the
  /// direction.
  bool is_perspective = false;

  /// [m] Only what is in front of it, further along the direction, is seen.
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
};

/// @throws std::invalid_argument naming what is wrong, its value and what is allowed
void validate(const View& view);

}  // namespace fiber
