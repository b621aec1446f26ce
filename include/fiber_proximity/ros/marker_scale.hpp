#pragma once

#include <Eigen/Geometry>
#include <limits>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber_proximity_ros {

/// Lengths that annotations are measured in [m].
struct MarkerScale {
  explicit MarkerScale(const fiber::FiberAssembly& fibers);

  double thickest = 0.0;                                      ///< largest radius
  double thinnest = std::numeric_limits<double>::infinity();  ///< smallest radius
  double extent = 0.0;                                        ///< longest side of the box
  Eigen::Vector3d top = Eigen::Vector3d::Zero();              ///< middle of the box's upper side
  Eigen::AlignedBox3d box;                                    ///< around the points
};

}  // namespace fiber_proximity_ros
