#include "fiber_proximity/query/pair_collector.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <utility>

#include "fiber_proximity/bounds/bounding_volume.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

bool closer(const Contact& x, const Contact& y) {
  return x.distance < y.distance || (x.distance == y.distance && x.key() < y.key());
}

std::size_t capacity_of(const QueryOptions& options) {
  switch (options.type) {
    case QueryType::CLOSEST:
      return 1;
    case QueryType::LIMITED:
      return options.max_contacts;
    case QueryType::FIRST:
    case QueryType::ALL:
      break;
  }
  return 0;
}

std::vector<double> arc_lengths(const FiberAssembly& fibers) {
  std::vector<double> lengths(fibers.point_count(), 0.0);
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t p = fibers.offsets()[fiber] + 1; p < fibers.offsets()[fiber + 1]; ++p) {
      lengths[p] = lengths[p - 1] + (fibers.points()[p] - fibers.points()[p - 1]).norm();
    }
  }
  return lengths;
}

/// A unit vector at right angles to both axes where they meet: that of the cross product, or any
/// at right angles to the longer one when they are parallel.
Vector3d normal_of_crossing(const Capsule& a, const Capsule& b) {
  const Vector3d u = (a.p1 - a.p0).stableNormalized();
  const Vector3d v = (b.p1 - b.p0).stableNormalized();
  const Vector3d normal = u.cross(v);
  if (!normal.isZero(0.0)) {
    return normal.stableNormalized();
  }
  const Vector3d axis = u.isZero(0.0) ? v : u;
  return axis.isZero(0.0) ? Vector3d::UnitZ() : axis.unitOrthogonal();
}

Contact make_contact(const Capsule& a, const Capsule& b, const SegmentDistance& nearest,
                     double gap) {
  Contact contact;
  contact.s = nearest.s;
  contact.t = nearest.t;
  contact.distance = gap;
  contact.normal = nearest.distance > 0.0 ? Vector3d(nearest.delta.stableNormalized())
                                          : normal_of_crossing(a, b);
  contact.point_a = (1.0 - nearest.s) * a.p0 + nearest.s * a.p1 + a.radius * contact.normal;
  contact.point_b = (1.0 - nearest.t) * b.p0 + nearest.t * b.p1 - b.radius * contact.normal;
  return contact;
}

}  // namespace

PairCollector::PairCollector(const FiberAssembly& fibers, const QueryOptions& options,
                             QueryResult& result)
    : PairCollector(fibers, fibers, true, options, result) {
  if (options.neighbour_skip_length > 0.0) {
    arc_length_ = arc_lengths(fibers);
  }
}

PairCollector::PairCollector(const FiberAssembly& shape, const FiberAssembly& fibers,
                             const QueryOptions& options, QueryResult& result)
    : PairCollector(shape, fibers, false, options, result) {}

PairCollector::PairCollector(const FiberAssembly& a, const FiberAssembly& b, bool self,
                             const QueryOptions& options, QueryResult& result)
    : a_(a),
      b_(b),
      options_(options),
      result_(result),
      self_(self),
      capacity_(capacity_of(options)) {
  set_bound(options.margin);
}

void PairCollector::offer(std::uint32_t point_a, std::uint32_t point_b) {
  if (self_) {
    if (point_b < point_a) {
      std::swap(point_a, point_b);
    }
    if (is_neighbour_pair(point_a, point_b)) {
      return;
    }
  }
  ++result_.counts.primitive_tests;
  const Capsule a = a_.capsule(point_a);
  const Capsule b = b_.capsule(point_b);
  const SegmentDistance nearest = segment_distance(a.p0, a.p1, b.p0, b.p1);
  const double gap = nearest.distance - (a.radius + b.radius);
  if (gap > bound_) {
    return;
  }
  Contact contact = make_contact(a, b, nearest, gap);
  const SegmentId id_a = a_.segment_id(point_a);
  const SegmentId id_b = b_.segment_id(point_b);
  contact.fiber_a = id_a.fiber;
  contact.segment_a = id_a.segment;
  contact.fiber_b = id_b.fiber;
  contact.segment_b = id_b.segment;
  keep(contact);
}

void PairCollector::keep(const Contact& contact) {
  std::vector<Contact>& contacts = result_.contacts;
  if (capacity_ == 0) {
    contacts.push_back(contact);
    done_ = options_.type == QueryType::FIRST;
    return;
  }
  // A heap with the farthest of the k closest on top.
  if (contacts.size() == capacity_) {
    if (!closer(contact, contacts.front())) {
      return;
    }
    std::pop_heap(contacts.begin(), contacts.end(), closer);
    contacts.pop_back();
  }
  contacts.push_back(contact);
  std::push_heap(contacts.begin(), contacts.end(), closer);
  if (contacts.size() == capacity_) {
    set_bound(contacts.front().distance);
  }
}

void PairCollector::finish() {
  std::vector<Contact>& contacts = result_.contacts;
  result_.limit_reached =
      options_.type == QueryType::LIMITED && contacts.size() == options_.max_contacts;
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& x, const Contact& y) { return x.key() < y.key(); });
}

bool PairCollector::is_neighbour_pair(std::uint32_t point_a, std::uint32_t point_b) const {
  const bool near_by_index = point_b - point_a <= options_.neighbour_skip;
  const bool near_by_length =
      !arc_length_.empty() &&
      arc_length_[point_b] - arc_length_[point_a + 1] < options_.neighbour_skip_length;
  if (!near_by_index && !near_by_length) {
    return false;
  }
  return a_.segment_id(point_a).fiber == a_.segment_id(point_b).fiber;
}

void PairCollector::set_bound(double bound) {
  bound_ = bound;
  // Capsules that penetrate have volumes that overlap: those know no negative margin.
  rounded_bound_ = round_up(std::max(bound, 0.0));
}

}  // namespace fiber
