#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fiber_proximity/environment/environment.hpp"
#include "src/geometry/norm.hpp"

namespace fiber {

/// How an object moves from its pose, from time 0 to time 1: its origin moves linearly, and it
/// turns about the origin at a constant rate, about an axis that stays the same in the world.
class ObjectPath {
 public:
  /// To another pose, turning the shorter way round, as tf interpolates. Refers to the first pose.
  ObjectPath(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after)
      : before_(&before), way_(after.translation() - before.translation()) {
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

  /// By a displacement. Refers to it and to the pose.
  ObjectPath(const Eigen::Isometry3d& before, const ObjectDisplacement& displacement)
      : before_(&before), displacement_(&displacement), way_(displacement.translation) {
    const double turn = norm_of(displacement.rotation);
    if (turn > 0.0) {
      // Columns of the pose's rotation may be longer than 1 by a little, which validate() allows.
      angle_ = turn * (1.0 + 0x1p-18) + 0x1p-48;
      rotation_error_ = 0x1p-44 + 0x1p-48 * turn;
    }
  }

  Eigen::Vector3d origin(double time) const { return before_->translation() + time * way_; }

  Eigen::Isometry3d pose(double time) const {
    Eigen::Isometry3d pose = *before_;
    pose.translation() = origin(time);
    if (!turns()) {
      return pose;
    }
    if (displacement_ != nullptr) {
      const Eigen::AngleAxisd turn(time * norm_of(displacement_->rotation),
                                   unit_of(displacement_->rotation));
      pose.linear() = turn.toRotationMatrix() * before_->linear();
    } else {
      pose.linear() = first_.slerp(time, last_).normalized().toRotationMatrix();
    }
    return pose;
  }

  bool moves() const { return turns() || way_ != Eigen::Vector3d::Zero(); }
  bool turns() const { return angle_ > 0.0; }
  double angle() const { return angle_; }              ///< [rad] at least that of the whole turn
  const Eigen::Vector3d& way() const { return way_; }  ///< of the origin [m]

  /// By how much the rotations of pose() differ from those that were given, which need not quite be
  /// rotations: a point at distance r is off by less than r times this.
  double rotation_error() const { return rotation_error_; }

  /// [m] How far points at this distance from the origin [m] may be from the straight way between
  /// where they are at both ends.
  double arc_height(double distance) const {
    // An arc of length s rises less than s²/8 of its radius; and both ways are within the distance
    // of the origin's.
    constexpr double part = 1.0 / 8.0;
    const double height = std::min(part * angle_ * angle_ * (1.0 + 0x1p-40), 2.0 + 0x1p-17);
    return distance * (height + rotation_error_);
  }

  /// [m] How far points at this distance from the origin [m] may be, at any time, from where they
  /// would be if the object did not turn.
  double turn_length(double distance) const {
    return distance * (std::min(angle_, 2.0 + 0x1p-17) + rotation_error_);
  }

 private:
  const Eigen::Isometry3d* before_;
  const ObjectDisplacement* displacement_ = nullptr;
  Eigen::Vector3d way_;
  Eigen::Quaterniond first_;  // these two where it turns to a pose
  Eigen::Quaterniond last_;
  double angle_ = 0.0;
  double rotation_error_ = 0.0;
};

}  // namespace fiber
