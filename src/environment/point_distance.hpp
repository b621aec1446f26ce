#pragma once

#include <Eigen/Core>

#include "fiber_proximity/environment/shapes.hpp"

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

}  // namespace fiber
