#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// How an object moves from one pose, at time 0, to another, at time 1: its origin moves linearly,
/// and it turns at a constant rate about one axis, the shorter way round, as tf interpolates.
class ObjectPath {
 public:
  ObjectPath(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after)
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

  Eigen::Isometry3d pose(double time) const {
    Eigen::Isometry3d pose = before_;
    pose.translation() += time * way_;
    if (turns()) {
      pose.linear() = first_.slerp(time, last_).normalized().toRotationMatrix();
    }
    return pose;
  }

  bool turns() const { return angle_ > 0.0; }
  double angle() const { return angle_; }              ///< [rad] at least that of the whole turn
  const Eigen::Vector3d& way() const { return way_; }  ///< of the origin [m]

  /// By how much the rotations of pose() differ from those that were given, which need not quite be
  /// rotations: a point at distance r is off by less than r times this.
  double rotation_error() const { return rotation_error_; }

  /// [m] How far points at this distance from the origin [m] may be from the straight way between
  /// where they are at both ends.
  double arc_height(double distance) const {
    constexpr double part = 1.0 / 8.0;  // of an arc of length s: less than s²/8 of its radius
    return distance * (part * angle_ * angle_ * (1.0 + 0x1p-40) + rotation_error_);
  }

 private:
  Eigen::Isometry3d before_;
  Eigen::Vector3d way_;
  Eigen::Quaterniond first_ = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond last_ = Eigen::Quaterniond::Identity();
  double angle_ = 0.0;
  double rotation_error_ = 0.0;
};

/// A shape of an object where it is in the world, and perhaps where it moves from there.
struct WorldShape {
  WorldShape(const EnvironmentObject& owner, std::uint32_t object_index, std::uint32_t shape_index)
      : object(object_index),
        index(shape_index),
        shape(owner.shapes[shape_index].shape),
        in_object(owner.shapes[shape_index].pose),
        pose(owner.pose * in_object),
        to_shape(pose.inverse(Eigen::Isometry)),
        box(world_box(shape, pose)),
        rounding(0x1p-48 * (reach(shape) + pose.translation().cwiseAbs().maxCoeff())) {}

  /// Makes the box one around the whole way. Refers to the path.
  void move_along(const ObjectPath& object_path) {
    path = &object_path;
    const double far = reach(shape) + in_object.translation().norm();
    const WorldBox last = world_box(shape, object_path.pose(1.0) * in_object);
    const Eigen::Vector3d padding = Eigen::Vector3d::Constant(object_path.arc_height(far));
    box.extend(last);
    box.min() -= padding;
    box.max() += padding;
  }

  /// [m] How much the distance of a segment from the shape may be off.
  double error(const Capsule& segment) const {
    return rounding +
           0x1p-48 * std::max(segment.p0.cwiseAbs().maxCoeff(), segment.p1.cwiseAbs().maxCoeff());
  }

  std::uint32_t object;
  std::uint32_t index;  // of the shape in its object
  const Shape& shape;
  const Eigen::Isometry3d& in_object;
  Eigen::Isometry3d pose;
  Eigen::Isometry3d to_shape;
  WorldBox box;
  double rounding;                   // [m] what its place adds to the error of a distance
  const ObjectPath* path = nullptr;  // null where it stands still
};

}  // namespace fiber
