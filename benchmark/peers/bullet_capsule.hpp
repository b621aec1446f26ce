#pragma once

#include <BulletCollision/CollisionShapes/btCapsuleShape.h>

#include "benchmark/peers/capsule_pose.hpp"

namespace fiber {

/// A segment as an object of Bullet, whose capsules stand along y.
struct BulletCapsule {
  BulletCapsule(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, double capsule_radius)
      : radius(capsule_radius), shape(capsule_radius, (p1 - p0).stableNorm()) {
    const CapsulePose found = capsule_pose(p0, p1);
    const Eigen::Vector3d& x = found.other;
    const Eigen::Vector3d& y = found.along;
    const Eigen::Vector3d& z = found.side;
    pose.setBasis({x.x(), y.x(), z.x(), x.y(), y.y(), z.y(), x.z(), y.z(), z.z()});
    pose.setOrigin({found.centre.x(), found.centre.y(), found.centre.z()});
  }

  double radius;
  btCapsuleShape shape;
  btTransform pose;
};

}  // namespace fiber
