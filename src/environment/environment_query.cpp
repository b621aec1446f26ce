#include "src/environment/environment_query.hpp"

#include <algorithm>
#include <limits>

#include "src/environment/broad_phase.hpp"

namespace fiber {
SegmentRun::SegmentRun(const FiberAssembly& fibers, std::uint32_t owner, std::uint32_t first_point,
                       std::uint32_t last_point)
    : fiber(owner), begin(first_point), end(last_point) {
  box.extend(fibers.points()[end]);
  for (std::uint32_t point = begin; point < end; ++point) {
    box.extend(fibers.points()[point]);
    radius = std::max(radius, fibers.segment_radius(point));
  }
}

Contact contact_of(const Capsule& capsule, const WorldShape& shape, const AxisDistance& axis) {
  const Eigen::Vector3d nearest = capsule.p0 + axis.s * (capsule.p1 - capsule.p0);
  const Eigen::Vector3d away = shape.pose.linear() * axis.gradient;
  const double error = shape.rounding + 0x1p-48 * std::max(capsule.p0.cwiseAbs().maxCoeff(),
                                                           capsule.p1.cwiseAbs().maxCoeff());
  Contact contact;
  contact.s = axis.s;
  contact.fiber_b = shape.object;
  contact.segment_b = shape.index;
  contact.distance = axis.distance - capsule.radius;
  contact.lower = axis.lower - error - capsule.radius;
  contact.upper = axis.distance + error - capsule.radius;
  contact.normal = -away;
  contact.point_a = nearest - capsule.radius * away;
  contact.point_b = nearest - axis.distance * away;
  return contact;
}

EnvironmentQuery::EnvironmentQuery(const FiberAssembly& fibers,
                                   const std::vector<EnvironmentObject>& objects,
                                   const QueryOptions& options, const AllowedPairs& allowed,
                                   QueryResult& result)
    : accumulator_(options, result),
      fibers_(fibers),
      allowed_(allowed, objects),
      counts_(result.counts) {}

double EnvironmentQuery::offer(const SegmentRun& run, const WorldShape& shape) {
  ++counts_.node_tests;
  const double bound = accumulator_.bound_of(run.fiber, shape.object);
  if (run.box.exteriorDistance(shape.box) > std::max(bound + run.radius, 0.0)) {
    accumulator_.leave_out(bound);
    return reach_of(run);
  }
  ++counts_.node_overlaps;
  for (std::uint32_t point = run.begin; point < run.end; ++point) {
    if (accumulator_.done()) {
      return -std::numeric_limits<double>::infinity();
    }
    offer_segment(run, point, shape);
  }
  return reach_of(run);
}

void EnvironmentQuery::offer_segment(const SegmentRun& run, std::uint32_t point,
                                     const WorldShape& shape) {
  const std::uint32_t first = fibers_.offsets()[run.fiber];
  if (allowed_.holds(fibers_, {run.fiber, point - first}, shape.object)) {
    return;
  }
  const Capsule capsule = fibers_.capsule(point);
  const double bound = accumulator_.bound_of(run.fiber, shape.object);
  const double within = bound + capsule.radius;
  const WorldBox box(capsule.p0.cwiseMin(capsule.p1), capsule.p0.cwiseMax(capsule.p1));
  if (box.exteriorDistance(shape.box) > std::max(within, 0.0)) {
    accumulator_.leave_out(bound);
    return;
  }
  if (!accumulator_.takes_pair()) {
    return;
  }
  ++counts_.primitive_tests;
  const AxisDistance axis =
      axis_distance(shape.shape, shape.to_shape * capsule.p0, shape.to_shape * capsule.p1, within);
  if (axis.distance == std::numeric_limits<double>::infinity()) {
    accumulator_.leave_out(bound);
    return;
  }
  Contact found = contact_of(capsule, shape, axis);
  found.fiber_a = run.fiber;
  found.segment_a = point - first;
  if (found.distance <= bound) {
    accumulator_.keep(found);
  } else {
    accumulator_.leave_out(found.lower);
  }
}

void EnvironmentQuery::finish() { accumulator_.finish(-std::numeric_limits<double>::infinity()); }

}  // namespace fiber
