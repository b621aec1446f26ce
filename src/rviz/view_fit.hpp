#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace rviz {
class ViewController;
}  // namespace rviz

namespace fiber_proximity_rviz {

/// Where a camera looks that orbits a focal point, with z upwards, and how wide it sees.
struct OrbitView {
  double yaw = 0.0;    ///< [rad] about z, of the direction from the focal point to the camera
  double pitch = 0.0;  ///< [rad] of that direction above the plane of x and y
  double tan_half_width =
      1.0;  ///< of the angle from the picture's middle to its left or right side
  double tan_half_height = 1.0;  ///< of the angle to its upper or lower side

  // The camera's axes, unit vectors:
  Eigen::Vector3d to_camera() const {
    return {std::cos(yaw) * std::cos(pitch), std::sin(yaw) * std::cos(pitch), std::sin(pitch)};
  }
  Eigen::Vector3d right() const { return {-std::sin(yaw), std::cos(yaw), 0.0}; }
  Eigen::Vector3d up() const { return to_camera().cross(right()); }
};

/// The camera position that shows the fibres.
struct ViewFit {
  Eigen::Vector3d focal_point = Eigen::Vector3d::Zero();
  double distance = 0.0;  ///< [m] of the camera from there
};

/// Fits the view to points: they reach over `share` of the picture's width or height, whichever is
/// less, and at most over that much of the other. What is near them and thick, or written above
/// them, has room beside.
/// @param points [m] at least one
/// @param share  above 0 and at most 1
inline ViewFit fit_view(const std::vector<Eigen::Vector3d>& points, const OrbitView& view,
                        double share) {
  assert(!points.empty() && share > 0.0 && share <= 1.0);
  const Eigen::Vector3d to_camera = view.to_camera();
  const Eigen::Vector3d right = view.right();
  const Eigen::Vector3d up = view.up();
  // As the camera has them: to the right, upwards, towards it.
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) {
    box.extend(Eigen::Vector3d(right.dot(point), up.dot(point), to_camera.dot(point)));
  }
  const Eigen::Vector3d center = box.center();
  ViewFit fit;
  fit.focal_point = center.x() * right + center.y() * up + center.z() * to_camera;
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d offset = point - fit.focal_point;
    const double sideways = std::max(std::abs(right.dot(offset)) / view.tan_half_width,
                                     std::abs(up.dot(offset)) / view.tan_half_height);
    fit.distance = std::max(fit.distance, to_camera.dot(offset) + sideways / share);
  }
  return fit;
}

/// Whether points are in the picture, `share` of it at most from its middle to each side.
/// @param fit where the camera is
inline bool is_in_view(const std::vector<Eigen::Vector3d>& points, const OrbitView& view,
                       const ViewFit& fit, double share) {
  const Eigen::Vector3d to_camera = view.to_camera();
  const Eigen::Vector3d right = view.right();
  const Eigen::Vector3d up = view.up();
  return std::all_of(points.begin(), points.end(), [&](const Eigen::Vector3d& point) {
    const Eigen::Vector3d offset = point - fit.focal_point;
    const double reach = share * (fit.distance - to_camera.dot(offset));
    return std::abs(right.dot(offset)) <= reach * view.tan_half_width &&
           std::abs(up.dot(offset)) <= reach * view.tan_half_height;
  });
}

/// Moves rviz's view to where fibres are: once, and again when there are more of them, as long as
/// nobody has moved it since.
class ViewFitter {
 public:
  /// The next fibres are the first ones again.
  void forget() { fiber_count_ = 0; }

  /// Shows fibres, if that is due. rviz's orbit view is fitted to them. In an optical frame (by its
  /// name; z forwards, y downwards: REP 103) it looks from above the camera forwards, in any other
  /// from where it looks already. Other kinds of views look at their middle.
  /// @param frame the fixed frame
  /// @param pose  of the fibres' frame in it
  /// @param keep  it is due, too, when fibres are about to leave the picture of an orbit view
  void fit(rviz::ViewController& view, const std::string& frame, const fiber::FiberAssembly& fibers,
           const Eigen::Isometry3d& pose, bool keep);

 private:
  std::size_t fiber_count_ = 0;      // of those last fitted to
  std::vector<float> fitted_state_;  // the state of the view after that
  ViewFit fit_;                      // what it was fitted to
};

}  // namespace fiber_proximity_rviz
