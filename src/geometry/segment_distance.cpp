#include "fiber_proximity/geometry/segment_distance.hpp"

#include <cmath>

#include "src/geometry/segment_distance-inl.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using OneLane = hwy::HWY_NAMESPACE::CappedTag<double, 1>;
using Distance = HWY_NAMESPACE::LaneDistance<OneLane>;

Distance::Vector in_lane(const Vector3d& vector) {
  const OneLane d;
  return {hwy::HWY_NAMESPACE::Set(d, vector.x()), hwy::HWY_NAMESPACE::Set(d, vector.y()),
          hwy::HWY_NAMESPACE::Set(d, vector.z())};
}

double value(Distance::V lane) { return hwy::HWY_NAMESPACE::GetLane(lane); }

Vector3d value(const Distance::Vector& lane) {
  return {value(lane.x), value(lane.y), value(lane.z)};
}

void scale(Distance::Vector& vector, int exponent) {
  vector = in_lane(value(vector).unaryExpr([=](double x) { return std::ldexp(x, exponent); }));
}

}  // namespace

SegmentDistance segment_distance(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                                 const Vector3d& q1) {
  Distance::Differences differences{in_lane(p1 - p0), in_lane(q1 - q0), in_lane(p0 - q0),
                                    in_lane(p1 - q0), in_lane(p0 - q1)};
  const double extent = value(Distance::extent(in_lane(p0), in_lane(p1), in_lane(q0), in_lane(q1)));
  int exponent = 0;
  if (extent > 0.0 && !(extent > least_distance_scale && extent < largest_distance_scale)) {
    exponent = std::ilogb(extent);
    for (Distance::Vector* difference :
         {&differences.u, &differences.v, &differences.w, &differences.w_u, &differences.w_v}) {
      scale(*difference, -exponent);
    }
  }
  const Distance nearest(differences);

  SegmentDistance result{value(nearest.s), value(nearest.t), -value(nearest.delta),
                         std::sqrt(value(nearest.squared)), robust_error * extent};
  if (exponent != 0) {
    result.distance = std::ldexp(result.distance, exponent);
    result.delta = result.delta.unaryExpr([=](double x) { return std::ldexp(x, exponent); });
    // Distance and error may have been rounded once more, where they are subnormal.
    result.error += std::numeric_limits<double>::denorm_min();
  }
  return result;
}

}  // namespace fiber
