#include "src/ros/outputs/marker_scale.hpp"

#include <algorithm>
#include <cmath>

#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/outputs/tube_mesh.hpp"

namespace fiber_proximity_ros {

MarkerScale::MarkerScale(const fiber::FiberAssembly& fibers, const std::string& frame)
    : up(is_optical_frame(frame) ? Eigen::Vector3d(-Eigen::Vector3d::UnitY())
                                 : Eigen::Vector3d(Eigen::Vector3d::UnitZ())) {
  for (const double radius : fibers.radii()) {
    thickest = std::max(thickest, radius);
    thinnest = std::min(thinnest, radius);
  }
  thickest = std::max(thickest, hairline_radius);
  thinnest = std::max(thinnest, hairline_radius);
  if (fibers.points().empty()) {
    return;
  }
  for (const Eigen::Vector3d& point : fibers.points()) {
    box.extend(point);
  }
  extent = std::max(box.sizes().maxCoeff(), thickest);
  const Eigen::Vector3d half = 0.5 * box.max() - 0.5 * box.min();
  top = box.min() + half + std::abs(up.dot(half)) * up;
}

}  // namespace fiber_proximity_ros
