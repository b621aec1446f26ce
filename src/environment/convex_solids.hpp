#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"

namespace fiber {

/// How far a point is from a solid's surface, negative inside, and along which way.
struct PointDistance {
  double distance = 0.0;     ///< [m]
  Eigen::Vector3d gradient;  ///< unit vector: the distance grows along it
};

/// Signed distance of a point in the shape's frame, in closed form. As all these shapes are convex,
/// so is the function, and the gradient is a subgradient everywhere: where there is more than one
/// nearest point, that of one of them. A plane's distance is never negative.
PointDistance point_distance(const BoxShape& box, const Eigen::Vector3d& point);
PointDistance point_distance(const SphereShape& sphere, const Eigen::Vector3d& point);
PointDistance point_distance(const CylinderShape& cylinder, const Eigen::Vector3d& point);
PointDistance point_distance(const ConeShape& cone, const Eigen::Vector3d& point);
PointDistance point_distance(const CapsuleShape& capsule, const Eigen::Vector3d& point);
PointDistance point_distance(const HalfSpaceShape& half_space, const Eigen::Vector3d& point);
PointDistance point_distance(const PlaneShape& plane, const Eigen::Vector3d& point);

/// Least signed distance of the points of a segment [m] from a convex solid.
///
/// The signed distance of a convex solid is a convex function. Two tangents of such a function of
/// one parameter, on either side of its minimum, meet below it: that is `lower`, and where they
/// meet, or where the slope between them would vanish, is looked next, until rounding alone is
/// left (J. E. Kelley 1960, "The cutting-plane method for solving convex programs").
template <class Solid>
AxisDistance axis_distance(const Solid& solid, const Eigen::Vector3d& p0,
                           const Eigen::Vector3d& p1);

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
