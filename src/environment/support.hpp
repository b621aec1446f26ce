#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/environment/triangle_distance.hpp"

namespace fiber {

// The largest n·x of the points x of a convex solid in its frame [m], n of any length; infinity if
// there is none. Where all of a segment is beyond that by more than d, it is further than d from
// the solid, whatever n of unit length is.

inline double support(const BoxShape& box, const Eigen::Vector3d& n) {
  return 0.5 * n.cwiseAbs().dot(box.size);
}

inline double support(const SphereShape& sphere, const Eigen::Vector3d& n) {
  return sphere.radius * n.norm();
}

inline double support(const CylinderShape& cylinder, const Eigen::Vector3d& n) {
  return 0.5 * cylinder.height * std::abs(n.z()) + cylinder.radius * std::hypot(n.x(), n.y());
}

inline double support(const ConeShape& cone, const Eigen::Vector3d& n) {
  const double apex = 0.5 * cone.height * n.z();
  return std::max(apex, cone.radius * std::hypot(n.x(), n.y()) - apex);
}

inline double support(const CapsuleShape& capsule, const Eigen::Vector3d& n) {
  return 0.5 * capsule.length * std::abs(n.z()) + capsule.radius * n.norm();
}

inline double support(const HalfSpaceShape& half_space, const Eigen::Vector3d& n) {
  return n == half_space.normal ? half_space.offset : std::numeric_limits<double>::infinity();
}

inline double support(const PlaneShape& plane, const Eigen::Vector3d& n) {
  if (n == plane.normal) {
    return plane.offset;
  }
  return n == -plane.normal ? -plane.offset : std::numeric_limits<double>::infinity();
}

inline double support(const TriangleCorners& triangle, const Eigen::Vector3d& n) {
  return std::max({n.dot(triangle[0]), n.dot(triangle[1]), n.dot(triangle[2])});
}

}  // namespace fiber
