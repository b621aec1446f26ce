#pragma once

#include <Eigen/Geometry>

namespace fiber {

/// How an object moves from one pose, at time 0, to another, at time 1: its origin moves linearly,
/// and it turns at a constant rate about one axis, the shorter way round, as tf interpolates.
class ObjectPath {
 public:
  ObjectPath(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after);

  Eigen::Isometry3d pose(double time) const;

  bool turns() const { return angle_ > 0.0; }
  double angle() const { return angle_; }              ///< [rad] at least that of the whole turn
  const Eigen::Vector3d& way() const { return way_; }  ///< of the origin [m]

  /// By how much the rotations of pose() differ from those that were given, which need not quite be
  /// rotations: a point at distance r is off by less than r times this.
  double rotation_error() const { return rotation_error_; }

  /// [m] How far points at this distance from the origin [m] may be from the straight way between
  /// where they are at both ends.
  double arc_height(double distance) const;

 private:
  Eigen::Isometry3d before_;
  Eigen::Vector3d way_;
  Eigen::Quaterniond first_ = Eigen::Quaterniond::Identity();
  Eigen::Quaterniond last_ = Eigen::Quaterniond::Identity();
  double angle_ = 0.0;
  double rotation_error_ = 0.0;
};

}  // namespace fiber
