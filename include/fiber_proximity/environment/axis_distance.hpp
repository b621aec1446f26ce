#pragma once

#include <Eigen/Core>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber {

/// Where the axis of a fibre's segment is nearest to a shape, or deepest in it, in the shape's
/// frame.
struct AxisDistance {
  double s = 0.0;         ///< parameter on the segment, 0 at its first point and 1 at its second
  double distance = 0.0;  ///< [m] signed distance of that point, negative inside
  double lower = 0.0;     ///< [m] no point of the segment has a smaller one, rounding apart
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitX();  ///< away from the shape, of unit length
};

/// Least signed distance of the points of a segment [m] from a solid.
///
/// The signed distance of a convex solid is a convex function. Two tangents of such a function of
/// one parameter, on either side of its minimum, meet below it: that is `lower`, and where they
/// meet, or where the slope between them would vanish, is looked next, until rounding alone is
/// left (J. E. Kelley 1960, "The cutting-plane method for solving convex programs").
template <class Solid>
AxisDistance axis_distance(const Solid& solid, const Eigen::Vector3d& p0,
                           const Eigen::Vector3d& p1);

/// The same of any shape. Of meshes and octrees nothing further away than the bound [m] is looked
/// for: their distance is infinite then.
AxisDistance axis_distance(const Shape& shape, const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                           double bound);

/// Largest distance of a shape's points from its frame's origin [m], 0 of an unbounded one; what
/// rounding errors are measured in.
double reach(const Shape& shape);

}  // namespace fiber
