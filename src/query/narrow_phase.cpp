#include "fiber_proximity/query/for_engines/narrow_phase.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/geometry/norm.hpp"
#include "src/query/graph_neighbours.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

std::vector<double> arc_lengths(const FiberAssembly& fibers) {
  std::vector<double> lengths(fibers.point_count(), 0.0);
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t p = fibers.offsets()[fiber] + 1; p < fibers.offsets()[fiber + 1]; ++p) {
      lengths[p] = lengths[p - 1] + norm_of(fibers.points()[p] - fibers.points()[p - 1]);
    }
  }
  return lengths;
}

/// A unit vector at right angles to both axes where they meet: that of the cross product, or any
/// at right angles to the longer one when they are parallel.
Vector3d normal_of_crossing(const Capsule& a, const Capsule& b) {
  const Vector3d u = unit_of(a.p1 - a.p0);
  const Vector3d v = unit_of(b.p1 - b.p0);
  const Vector3d normal = u.cross(v);
  if (!normal.isZero(0.0)) {
    return unit_of(normal);
  }
  const Vector3d axis = u.isZero(0.0) ? v : u;
  return axis.isZero(0.0) ? Vector3d::UnitZ() : axis.unitOrthogonal();
}

/// Unit vector from the first point to the second; at right angles to both axes where they meet.
Vector3d direction(const SegmentDistance& nearest, const Capsule& a, const Capsule& b) {
  return nearest.delta.isZero(0.0) ? normal_of_crossing(a, b) : unit_of(nearest.delta);
}

/// The error of the distance, and what the sum of the radii, the gap and its bounds are rounded by:
/// half an ε each. Where they are subnormal sums are exact.
double gap_error(const SegmentDistance& nearest, double radii) {
  return (1.0 + 0x1p-50) * nearest.error + 0x1p-51 * (radii + nearest.distance);
}

}  // namespace

Contact contact_of(const Capsule& a, const Capsule& b, const SegmentDistance& nearest) {
  const double radii = a.radius + b.radius;
  const double error = gap_error(nearest, radii);
  Contact contact;
  contact.s = nearest.s;
  contact.t = nearest.t;
  contact.distance = nearest.distance - radii;
  contact.lower = contact.distance - error;
  contact.upper = contact.distance + error;
  contact.normal = direction(nearest, a, b);
  contact.point_a = (1.0 - nearest.s) * a.p0 + nearest.s * a.p1 + a.radius * contact.normal;
  contact.point_b = (1.0 - nearest.t) * b.p0 + nearest.t * b.p1 - b.radius * contact.normal;
  return contact;
}

double NarrowPhase::gap_lower(PointPair pair, const PairDistance& distance) const {
  return distance.gap - gap_error(distance.nearest, radii(pair));
}

NarrowPhase::NarrowPhase(const FiberAssembly& fibers, const QueryOptions& options,
                         const LoopTest* loops)
    : a_(fibers),
      b_(fibers),
      options_(options),
      self_(true),
      neighbour_skip_(options.neighbour_skip.value_or(1)),
      neighbour_skip_length_(options.neighbour_skip_length.value_or(0.0)) {
  if (options.needs_loops()) {
    loops_ = loops != nullptr ? loops : &own_loops_.emplace(fibers);
  }
  if (neighbour_skip_length_ > 0.0) {
    arc_length_ = arc_lengths(fibers);
  }
  index_decides_ = arc_length_.empty() && fibers.graph() == nullptr;
}

NarrowPhase::NarrowPhase(const FiberAssembly& shape, const FiberAssembly& fibers,
                         const QueryOptions& options)
    : a_(shape),
      b_(fibers),
      options_(options),
      self_(false),
      neighbour_skip_(0),
      neighbour_skip_length_(0.0) {}

bool NarrowPhase::is_neighbour(PointPair pair) const {
  const bool near_by_index = pair.b - pair.a <= neighbour_skip_;
  const bool near_by_length =
      !arc_length_.empty() &&
      arc_length_[pair.b] - arc_length_[pair.a + 1] < neighbour_skip_length_;
  if ((near_by_index || near_by_length) && is_of_one_fiber(pair)) {
    return true;
  }
  return a_.graph() != nullptr &&
         (are_near_by_count(a_, pair, neighbour_skip_) ||
          (!arc_length_.empty() &&
           are_near_by_length(a_, arc_length_, pair, neighbour_skip_length_)));
}

PairDistance NarrowPhase::distance(PointPair pair) const {
  const Capsule a = a_.capsule(pair.a);
  const Capsule b = b_.capsule(pair.b);
  const SegmentDistance nearest = segment_distance(a.p0, a.p1, b.p0, b.p1);
  return {nearest, nearest.distance - radii(pair)};
}

void NarrowPhase::distances(const PointPair* pairs, std::size_t count,
                            PairDistance* distances) const {
  constexpr std::size_t block = 32;
  const Vector3d* starts_a[block];
  const Vector3d* starts_b[block];
  SegmentDistance nearest[block];
  for (std::size_t begin = 0; begin < count; begin += block) {
    const std::size_t size = std::min(block, count - begin);
    for (std::size_t i = 0; i < size; ++i) {
      starts_a[i] = &a_.points()[pairs[begin + i].a];
      starts_b[i] = &b_.points()[pairs[begin + i].b];
    }
    segment_distances(starts_a, starts_b, size, nearest);
    for (std::size_t i = 0; i < size; ++i) {
      const PointPair pair = pairs[begin + i];
      distances[begin + i] = {nearest[i], nearest[i].distance - radii(pair)};
    }
  }
}

bool NarrowPhase::is_within_margin(PointPair pair, const PairDistance& distance) const {
  if (options_.kernel == Kernel::ROBUST) {
    return distance.gap <= options_.margin;
  }
  const Capsule a = a_.capsule(pair.a);
  const Capsule b = b_.capsule(pair.b);
  return gap_at_most(distance.nearest, a.p0, a.p1, b.p0, b.p1,
                     {a.radius, b.radius, options_.margin});
}

double NarrowPhase::min_gap() const {
  return -(1.0 + 0x1p-51) * (a_.largest_radius() + b_.largest_radius());
}

double NarrowPhase::gap_lower_bound(PointPair pair) const {
  const Capsule a = a_.capsule(pair.a);
  const Capsule b = b_.capsule(pair.b);
  const Vector3d lower_a = a.p0.cwiseMin(a.p1);
  const Vector3d upper_a = a.p0.cwiseMax(a.p1);
  const Vector3d lower_b = b.p0.cwiseMin(b.p1);
  const Vector3d upper_b = b.p0.cwiseMax(b.p1);
  const double radii = a.radius + b.radius;
  // Axis by axis: squares could leave the range of double.
  const double apart = std::max((lower_b - upper_a).maxCoeff(), (lower_a - upper_b).maxCoeff());
  const double extent = std::max((upper_b - lower_a).maxCoeff(), (upper_a - lower_b).maxCoeff());
  // The computed distance is less than the true one by at most 7.4 roundings (2⁻⁵²) of the extent
  // (docs/numerics.md), the sums here and there err by less than one each. Where this underflows
  // those are exact, and the distance a rounded multiple of the smallest double, as `apart` is.
  const double error = 0x1p-48 * (extent + radii);
  return apart - radii - error;
}

Contact NarrowPhase::contact(PointPair pair, const PairDistance& distance) const {
  const Capsule a = a_.capsule(pair.a);
  const Capsule b = b_.capsule(pair.b);
  const SegmentId id_a = a_.segment_id(pair.a);
  const SegmentId id_b = b_.segment_id(pair.b);
  Contact contact =
      contact_of(a, b,
                 options_.kernel == Kernel::EXACT
                     ? rounded_segment_distance(distance.nearest, a.p0, a.p1, b.p0, b.p1)
                     : distance.nearest);
  static_cast<SegmentIdPair&>(contact) = {id_a.fiber, id_a.segment, id_b.fiber, id_b.segment};
  return contact;
}

}  // namespace fiber
