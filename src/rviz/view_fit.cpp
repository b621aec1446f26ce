#include "src/rviz/view_fit.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace fiber_proximity_rviz {

using Eigen::Vector3d;

ViewFit fit_view(const std::vector<Vector3d>& points, const OrbitView& view, double share) {
  assert(!points.empty() && share > 0.0 && share <= 1.0);
  const Vector3d to_camera(std::cos(view.yaw) * std::cos(view.pitch),
                           std::sin(view.yaw) * std::cos(view.pitch), std::sin(view.pitch));
  const Vector3d right(-std::sin(view.yaw), std::cos(view.yaw), 0.0);
  const Vector3d up = to_camera.cross(right);
  // As the camera has them: to the right, upwards, towards it.
  Eigen::AlignedBox3d box;
  for (const Vector3d& point : points) {
    box.extend(Vector3d(right.dot(point), up.dot(point), to_camera.dot(point)));
  }
  const Vector3d center = box.center();
  ViewFit fit;
  fit.focal_point = center.x() * right + center.y() * up + center.z() * to_camera;
  for (const Vector3d& point : points) {
    const Vector3d offset = point - fit.focal_point;
    const double sideways = std::max(std::abs(right.dot(offset)) / view.tan_half_width,
                                     std::abs(up.dot(offset)) / view.tan_half_height);
    fit.distance = std::max(fit.distance, to_camera.dot(offset) + sideways / share);
  }
  return fit;
}

}  // namespace fiber_proximity_rviz
