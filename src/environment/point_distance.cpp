#include "src/environment/point_distance.hpp"

#include <algorithm>
#include <cmath>

namespace fiber {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The unit vector of a difference; where there is none, any.
template <class Vector>
Vector direction_of(const Vector& difference, double length) {
  return length > 0.0 ? Vector(difference / length) : Vector(Vector::Unit(0));
}

/// Signed distance from the box |p| <= half of any dimension, and its gradient.
template <class Vector>
std::pair<double, Vector> box_distance(const Vector& point, const Vector& half) {
  const Vector beyond = point.cwiseAbs() - half;
  Eigen::Index axis = 0;
  if (beyond.maxCoeff(&axis) <= 0.0) {
    const double sign = point[axis] < 0.0 ? -1.0 : 1.0;
    return {beyond[axis], sign * Vector::Unit(axis)};
  }
  const Vector outside = beyond.cwiseMax(0.0);
  const double distance = outside.stableNorm();
  Vector gradient = outside / distance;
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    gradient[i] = std::copysign(gradient[i], point[i]);
  }
  return {distance, gradient};
}

/// A point by its distance from the z axis and its height, for solids of revolution.
struct Profile {
  explicit Profile(const Vector3d& point)
      : around(std::hypot(point.x(), point.y()), point.z()),
        outwards(direction_of<Vector2d>(point.head<2>(), around[0])) {}

  PointDistance revolved(const std::pair<double, Vector2d>& distance) const {
    const auto& [value, gradient] = distance;
    return {value, {gradient[0] * outwards[0], gradient[0] * outwards[1], gradient[1]}};
  }

  Vector2d around;    // [m] distance from the axis, height
  Vector2d outwards;  // unit vector away from the axis
};

/// From the point to the nearest one on a segment.
Vector2d to_segment(const Vector2d& point, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0.0 ? std::clamp((point - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return a + t * along - point;
}

}  // namespace

PointDistance point_distance(const BoxShape& box, const Vector3d& point) {
  const auto [distance, gradient] = box_distance<Vector3d>(point, box.size / 2.0);
  return {distance, gradient};
}

PointDistance point_distance(const SphereShape& sphere, const Vector3d& point) {
  const double length = point.stableNorm();
  return {length - sphere.radius, direction_of(point, length)};
}

PointDistance point_distance(const CylinderShape& cylinder, const Vector3d& point) {
  const Profile profile(point);
  // Half a rectangle: what is left of the axis is never nearest.
  return profile.revolved(
      box_distance<Vector2d>(profile.around, {cylinder.radius, cylinder.height / 2.0}));
}

PointDistance point_distance(const ConeShape& cone, const Vector3d& point) {
  const Profile profile(point);
  const double half = cone.height / 2.0;
  const Vector2d rim(cone.radius, -half);
  // Out of the slant; of a cone that is a point, upwards.
  const Vector2d slant =
      direction_of<Vector2d>({cone.height, cone.radius}, std::hypot(cone.height, cone.radius));
  const double above_slant = slant.dot(profile.around - rim);
  const double below_base = -half - profile.around[1];
  if (above_slant <= 0.0 && below_base <= 0.0) {
    return profile.revolved(above_slant >= below_base
                                ? std::make_pair(above_slant, slant)
                                : std::make_pair(below_base, Vector2d(0.0, -1.0)));
  }
  const Vector2d to_slant = to_segment(profile.around, rim, {0.0, half});
  const Vector2d to_base = to_segment(profile.around, {0.0, -half}, rim);
  const bool near_slant = to_slant.squaredNorm() < to_base.squaredNorm();
  const Vector2d to_nearest = near_slant ? to_slant : to_base;
  const double distance = to_nearest.stableNorm();
  if (distance == 0.0) {
    return profile.revolved({0.0, near_slant ? slant : Vector2d(0.0, -1.0)});
  }
  return profile.revolved({distance, -to_nearest / distance});
}

PointDistance point_distance(const CapsuleShape& capsule, const Vector3d& point) {
  const double half = capsule.length / 2.0;
  const Vector3d nearest(0.0, 0.0, std::clamp(point.z(), -half, half));
  return point_distance(SphereShape{capsule.radius}, point - nearest);
}

PointDistance point_distance(const HalfSpaceShape& half_space, const Vector3d& point) {
  return {half_space.normal.dot(point) - half_space.offset, half_space.normal};
}

PointDistance point_distance(const PlaneShape& plane, const Vector3d& point) {
  const double height = plane.normal.dot(point) - plane.offset;
  return {std::abs(height), height < 0.0 ? Vector3d(-plane.normal) : plane.normal};
}

}  // namespace fiber
