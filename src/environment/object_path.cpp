#include "src/environment/object_path.hpp"

#include <algorithm>
#include <cmath>

namespace fiber {

ObjectPath::ObjectPath(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after)
    : before_(before), way_(after.translation() - before.translation()) {
  if (before.linear() == after.linear()) {
    return;
  }
  first_ = Eigen::Quaterniond(before.linear()).normalized();
  last_ = Eigen::Quaterniond(after.linear()).normalized();
  if (first_.dot(last_) < 0.0) {
    last_.coeffs() *= -1.0;  // the shorter way round
  }
  // |q1 - q0| is twice the sine of a quarter of the angle; some roundings more.
  const double chord = (last_.coeffs() - first_.coeffs()).norm();
  angle_ = 4.0 * std::asin(std::min(0.5 * chord, 1.0)) * (1.0 + 0x1p-20) + 0x1p-48;
  rotation_error_ = 0x1p-44 + std::max((first_.toRotationMatrix() - before.linear()).norm(),
                                       (last_.toRotationMatrix() - after.linear()).norm());
}

Eigen::Isometry3d ObjectPath::pose(double time) const {
  Eigen::Isometry3d pose = before_;
  pose.translation() += time * way_;
  if (turns()) {
    pose.linear() = first_.slerp(time, last_).normalized().toRotationMatrix();
  }
  return pose;
}

double ObjectPath::arc_height(double distance) const {
  constexpr double part = 1.0 / 8.0;  // of an arc of length s: less than s²/8 of its radius
  return distance * (part * angle_ * angle_ * (1.0 + 0x1p-40) + rotation_error_);
}

}  // namespace fiber
