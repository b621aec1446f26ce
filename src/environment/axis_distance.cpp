#include "fiber_proximity/environment/axis_distance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "src/environment/occupancy_octree.hpp"
#include "src/environment/point_distance.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

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

struct Reach {
  double operator()(const BoxShape& box) const { return box.size.norm() / 2.0; }
  double operator()(const SphereShape& sphere) const { return sphere.radius; }
  double operator()(const CylinderShape& cylinder) const {
    return std::hypot(cylinder.radius, cylinder.height / 2.0);
  }
  double operator()(const ConeShape& cone) const {
    return std::hypot(cone.radius, cone.height / 2.0);
  }
  double operator()(const CapsuleShape& capsule) const {
    return capsule.radius + capsule.length / 2.0;
  }
  double operator()(const HalfSpaceShape& half_space) const { return std::abs(half_space.offset); }
  double operator()(const PlaneShape& plane) const { return std::abs(plane.offset); }
  template <class Shared>
  double operator()(const std::shared_ptr<const Shared>& shared) const {
    const WorldBox& box = shared->box();
    return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
  }
};

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

template <class Solid>
AxisDistance axis_distance(const Solid& solid, const Vector3d& p0, const Vector3d& p1) {
  constexpr int most_steps = 100;  // a third of them halve the interval at least
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
    if (best.value() - meeting.lower <= rounding || step == most_steps) {
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

double reach(const Shape& shape) { return std::visit(Reach(), shape); }

}  // namespace fiber
