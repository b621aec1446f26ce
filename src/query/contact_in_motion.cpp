#include "src/query/contact_in_motion.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/query/narrow_phase.hpp"

namespace fiber {
namespace {

std::uint32_t point_of(const FiberMotion& motion, std::uint32_t fiber, std::uint32_t segment) {
  return motion.before.offsets()[fiber] + segment;
}

double radius_in(const FiberMotion& motion, std::uint32_t point) {
  return std::max(motion.before.segment_radius(point), motion.after.segment_radius(point));
}

/// As a fibre of its own.
FiberAssembly fiber_of(const Capsule& segment) {
  return FiberAssembly({segment.p0, segment.p1}, {0, 2}, {segment.radius});
}

}  // namespace

Capsule capsule_at(const FiberMotion& motion, std::uint32_t point, double time) {
  const auto point_at = [&](std::uint32_t index) -> Eigen::Vector3d {
    return (1.0 - time) * motion.before.points()[index] + time * motion.after.points()[index];
  };
  return {point_at(point), point_at(point + 1), radius_in(motion, point)};
}

double time_of(const MotionContact& contact) {
  return std::isfinite(contact.upper) ? contact.upper : contact.lower;
}

Contact first_contact(const FiberMotion& a, const FiberMotion& b, const MotionContact& contact) {
  const double time = time_of(contact);
  const FiberAssembly segment_a =
      fiber_of(capsule_at(a, point_of(a, contact.fiber_a, contact.segment_a), time));
  const FiberAssembly segment_b =
      fiber_of(capsule_at(b, point_of(b, contact.fiber_b, contact.segment_b), time));
  const QueryOptions options;
  const NarrowPhase test(segment_a, segment_b, options);
  constexpr PointPair only_pair{0, 0};
  Contact found = test.contact(only_pair, test.distance(only_pair));
  found.fiber_a = contact.fiber_a;
  found.segment_a = contact.segment_a;
  found.fiber_b = contact.fiber_b;
  found.segment_b = contact.segment_b;
  return found;
}

LastContact last_contact(const FiberMotion& a, const FiberMotion& b, const MotionContact& contact,
                         const MotionOptions& options) {
  const std::uint32_t point_a = point_of(a, contact.fiber_a, contact.segment_a);
  const std::uint32_t point_b = point_of(b, contact.fiber_b, contact.segment_b);
  const SegmentMotions backward{&a.after.points()[point_a],
                                &a.before.points()[point_a],
                                &b.after.points()[point_b],
                                &b.before.points()[point_b],
                                {radius_in(a, point_a), radius_in(b, point_b), options.margin}};
  const ContactTime time = contact_time(backward, options.tolerance);
  // Near 0 doubles tell more than near 1: outwards to the next one.
  return {std::isfinite(time.upper) ? std::max(std::nextafter(1.0 - time.upper, 0.0), 0.0) : 0.0,
          std::min(std::nextafter(1.0 - time.lower, 2.0), 1.0),
          time.hit && time.certain && time.upper == 0.0};
}

}  // namespace fiber
