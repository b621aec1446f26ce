#include "src/rviz/view_fit.hpp"

#include <OgreCamera.h>
#include <rviz/view_controller.h>

#include <algorithm>
#include <cmath>

#include "src/ros/inputs/fixed_frame.hpp"

namespace fiber_proximity_rviz {
namespace {

constexpr double fitted_share = 0.65;  // of the viewport; names and legend have the rest
constexpr double refit_share = 0.85;   // where ends have no room for handles any more

bool is_orbit(const rviz::ViewController& view) { return view.getClassId() == "rviz/Orbit"; }

/// The numbers that the user changes by moving the view.
std::vector<float> view_state(rviz::ViewController& view) {
  std::vector<float> numbers;
  if (is_orbit(view)) {
    for (const char* name : {"Distance", "Pitch", "Yaw"}) {
      numbers.push_back(view.subProp(name)->getValue().toFloat());
    }
    for (const char* name : {"X", "Y", "Z"}) {
      numbers.push_back(view.subProp("Focal Point")->subProp(name)->getValue().toFloat());
    }
  }
  return numbers;
}

OrbitView orbit_view(rviz::ViewController& view, const std::string& frame) {
  OrbitView orbit;
  if (fiber_proximity_ros::is_optical_frame(frame)) {
    orbit.yaw = -M_PI_2;
    orbit.pitch = -0.9;
  } else {
    orbit.yaw = view.subProp("Yaw")->getValue().toDouble();
    orbit.pitch = view.subProp("Pitch")->getValue().toDouble();
  }
  const Ogre::Camera& camera = *view.getCamera();
  orbit.tan_half_height = std::tan(0.5 * camera.getFOVy().valueRadians());
  orbit.tan_half_width = orbit.tan_half_height * camera.getAspectRatio();
  return orbit;
}

}  // namespace

void ViewFitter::fit(rviz::ViewController& view, const std::string& frame,
                     const fiber::FiberAssembly& fibers, const Eigen::Isometry3d& pose, bool keep) {
  const bool is_first = fiber_count_ == 0;
  const bool is_untouched = is_orbit(view) && view_state(view) == fitted_state_;
  const bool are_more = fibers.fiber_count() > fiber_count_;
  if (fibers.fiber_count() == 0 || (!is_first && !is_untouched) || (!are_more && !keep)) {
    return;
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(fibers.point_count());
  for (const Eigen::Vector3d& point : fibers.points()) {
    points.push_back(pose * point);
  }
  const OrbitView orbit = is_orbit(view) ? orbit_view(view, frame) : OrbitView();
  if (!are_more && is_in_view(points, orbit, fit_, refit_share)) {
    return;
  }
  fiber_count_ = std::max(fiber_count_, fibers.fiber_count());
  fit_ = fit_view(points, orbit, fitted_share);
  view.lookAt(static_cast<float>(fit_.focal_point.x()), static_cast<float>(fit_.focal_point.y()),
              static_cast<float>(fit_.focal_point.z()));
  if (is_orbit(view)) {
    view.subProp("Distance")->setValue(fit_.distance);
    view.subProp("Pitch")->setValue(orbit.pitch);
    view.subProp("Yaw")->setValue(orbit.yaw);
  }
  fitted_state_ = view_state(view);
}

}  // namespace fiber_proximity_rviz
