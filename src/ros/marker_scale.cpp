#include "fiber_proximity/ros/marker_scale.hpp"

#include <algorithm>

#include "fiber_proximity/ros/tube_mesh.hpp"

namespace fiber_proximity_ros {

MarkerScale::MarkerScale(const fiber::FiberAssembly& fibers) {
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
  top = 0.5 * box.min() + 0.5 * box.max();
  top.z() = box.max().z();
}

}  // namespace fiber_proximity_ros
