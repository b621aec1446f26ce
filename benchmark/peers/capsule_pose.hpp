#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "validation/geometry/hard_pairs.hpp"

namespace fiber {

/// A segment as libraries of collision detection want it: along an axis, rotated and moved.
struct CapsulePose {
  Eigen::Vector3d centre;  ///< [m]
  Eigen::Vector3d along;   ///< unit vector; any for a segment of no length
  Eigen::Vector3d side;    ///< unit vectors perpendicular to it,
  Eigen::Vector3d other;   ///< right-handed: along = side × other
  double length = 0.0;     ///< [m]
};

inline CapsulePose capsule_pose(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1) {
  const Eigen::Vector3d axis = p1 - p0;
  CapsulePose pose;
  pose.centre = 0.5 * (p0 + p1);
  pose.length = axis.stableNorm();
  // Twice: the length of a tiny axis has few digits.
  pose.along = pose.length > 0.0 ? axis.stableNormalized().normalized() : Eigen::Vector3d::UnitZ();
  pose.side = pose.along.unitOrthogonal();
  pose.other = pose.along.cross(pose.side);
  return pose;
}

/// The capsules of pairs as objects of a library, made of two points and a radius [m].
template <class Capsule>
void make_capsules(const std::vector<HardPair>& pairs, std::vector<Capsule>& a,
                   std::vector<Capsule>& b) {
  a.clear();
  b.clear();
  for (const HardPair& pair : pairs) {
    a.emplace_back(pair.p0, pair.p1, pair.radius_a);
    b.emplace_back(pair.q0, pair.q1, pair.radius_b);
  }
}

}  // namespace fiber
