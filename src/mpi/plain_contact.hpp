#pragma once

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// A contact as it travels.
struct PlainContact {
  GlobalSegment a;
  GlobalSegment b;
  double s, t, distance, lower, upper;
  PlainPoint point_a, point_b, normal;
};

inline PlainContact plain_contact(const DistributedContact& contact) {
  return {{contact.fiber_a, contact.segment_a},
          {contact.fiber_b, contact.segment_b},
          contact.s,
          contact.t,
          contact.distance,
          contact.lower,
          contact.upper,
          plain(contact.point_a),
          plain(contact.point_b),
          plain(contact.normal)};
}

inline DistributedContact contact_from(const PlainContact& contact) {
  return {contact.a.fiber,
          contact.a.segment,
          contact.b.fiber,
          contact.b.segment,
          contact.s,
          contact.t,
          contact.distance,
          contact.lower,
          contact.upper,
          vector_of(contact.point_a),
          vector_of(contact.point_b),
          vector_of(contact.normal)};
}

/// Whether a contact comes before another.
inline bool is_before(const DistributedContact& x, const DistributedContact& y) {
  return x.key() < y.key();
}

}  // namespace fiber
