#pragma once

#include <fcl/geometry/shape/capsule.h>

#include "benchmark/peers/capsule_pose.hpp"

namespace fiber {

/// A segment as an object of FCL.
struct FclCapsule {
  FclCapsule(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1, double radius)
      : capsule(radius, 0.0), pose(fcl::Transform3d::Identity()) {
    const CapsulePose found = capsule_pose(p0, p1);
    capsule.lz = found.length;
    pose.linear().col(0) = found.side;
    pose.linear().col(1) = found.other;
    pose.linear().col(2) = found.along;
    pose.translation() = found.centre;
  }

  fcl::Capsuled capsule;
  fcl::Transform3d pose;
};

}  // namespace fiber
