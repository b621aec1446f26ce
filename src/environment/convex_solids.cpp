#include "src/environment/convex_solids.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "src/geometry/norm.hpp"

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
  const double distance = norm_of(outside);
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

/// The function and its slope at one point of the segment.
struct Sample {
  double s;
  PointDistance point;
  double slope;  // [m] along the whole segment

  double value() const { return point.distance; }
};

template <class Solid>
Sample sample(const Solid& solid, const Vector3d& p0, const Vector3d& along, double s) {
  const PointDistance point = point_distance(solid, p0 + s * along);
  return {s, point, point.gradient.dot(along)};
}

/// Between two samples, where the slopes have different signs: where the tangents meet, and how
/// low.
struct Meeting {
  Meeting(const Sample& left, const Sample& right) {
    const double rise = right.value() - left.value();
    const double width = right.s - left.s;
    // (0, 1) of the width, as left.slope * width <= rise <= right.slope * width.
    const double part =
        std::clamp((right.slope * width - rise) / ((right.slope - left.slope) * width), 0.0, 1.0);
    s = left.s + part * width;
    lower = left.value() + left.slope * part * width;
  }
  double s;
  double lower;  // [m]
};

AxisDistance answer(const Sample& sample, double lower) {
  return {sample.s, sample.value(), std::min(lower, sample.value()), sample.point.gradient};
}

struct DistanceOf {
  template <class Solid>
  AxisDistance operator()(const Solid& solid) const {
    return axis_distance(solid, p0, p1);
  }
  template <class Shared>
  AxisDistance operator()(const std::shared_ptr<const Shared>& shared) const {
    return shared->axis_distance(p0, p1, bound);
  }
  const Vector3d& p0;
  const Vector3d& p1;
  double bound;
};

}  // namespace

PointDistance point_distance(const BoxShape& box, const Vector3d& point) {
  const auto [distance, gradient] = box_distance<Vector3d>(point, box.size / 2.0);
  return {distance, gradient};
}

PointDistance point_distance(const SphereShape& sphere, const Vector3d& point) {
  const double length = norm_of(point);
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
  const double distance = norm_of(to_nearest);
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

template <class Solid>
AxisDistance axis_distance(const Solid& solid, const Vector3d& p0, const Vector3d& p1) {
  constexpr int max_steps = 100;  // a third of them halve the interval at least
  constexpr double epsilon = std::numeric_limits<double>::epsilon();
  const Vector3d along = p1 - p0;
  Sample left = sample(solid, p0, along, 0.0);
  Sample right = sample(solid, p0, along, 1.0);
  if (left.slope >= 0.0) {
    return answer(left, left.value());
  }
  if (right.slope <= 0.0) {
    return answer(right, right.value());
  }
  const double rounding = 4.0 * epsilon * (p0.cwiseAbs().maxCoeff() + p1.cwiseAbs().maxCoeff());
  Sample best = left.value() <= right.value() ? left : right;
  for (int step = 0;; ++step) {
    const Meeting meeting(left, right);
    if (best.value() - meeting.lower <= rounding || step == max_steps) {
      return answer(best, meeting.lower);
    }
    const double looks[] = {left.s + (right.s - left.s) * (left.slope / (left.slope - right.slope)),
                            meeting.s, (left.s + right.s) / 2.0};
    const double s = looks[step % 3];
    if (!(left.s < s && s < right.s)) {
      continue;  // rounding has reached an end; another way may not
    }
    const Sample next = sample(solid, p0, along, s);
    (next.slope < 0.0 ? left : right) = next;
    best = next.value() < best.value() ? next : best;
  }
}

template AxisDistance axis_distance(const BoxShape&, const Vector3d&, const Vector3d&);
template AxisDistance axis_distance(const SphereShape&, const Vector3d&, const Vector3d&);
template AxisDistance axis_distance(const CylinderShape&, const Vector3d&, const Vector3d&);
template AxisDistance axis_distance(const ConeShape&, const Vector3d&, const Vector3d&);
template AxisDistance axis_distance(const CapsuleShape&, const Vector3d&, const Vector3d&);
template AxisDistance axis_distance(const HalfSpaceShape&, const Vector3d&, const Vector3d&);
template AxisDistance axis_distance(const PlaneShape&, const Vector3d&, const Vector3d&);

AxisDistance axis_distance(const Shape& shape, const Vector3d& p0, const Vector3d& p1,
                           double bound) {
  return std::visit(DistanceOf{p0, p1, bound}, shape);
}

}  // namespace fiber
