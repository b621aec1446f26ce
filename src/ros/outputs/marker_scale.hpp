#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <string>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber_proximity_ros {

/// Lengths that annotations are measured in [m].
struct MarkerScale {
  /// @param frame of the fibres, which tells what is up
  MarkerScale(const fiber::FiberAssembly& fibers, const std::string& frame);

  /// Middle of the box's lower side.
  Eigen::Vector3d bottom() const { return top - std::abs(up.dot(box.sizes())) * up; }

  double thickest = 0.0;                                      ///< largest radius
  double thinnest = std::numeric_limits<double>::infinity();  ///< smallest radius
  double extent = 0.0;                                        ///< longest side of the box
  Eigen::Vector3d up;                             ///< unit vector: z, or −y in an optical frame
  Eigen::Vector3d top = Eigen::Vector3d::Zero();  ///< middle of the box's upper side
  Eigen::AlignedBox3d box;                        ///< around the points
};

}  // namespace fiber_proximity_ros
