#pragma once

#include <Eigen/Core>

namespace fiber {

/// A capped cylinder: all points within `radius` of the axis p0–p1. One segment of a fibre.
struct Capsule {
  Eigen::Vector3d p0;   ///< [m]
  Eigen::Vector3d p1;   ///< [m]
  double radius = 0.0;  ///< [m]
};

}  // namespace fiber
