#include "src/query/contact_in_motion.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/query/narrow_phase.hpp"

namespace fiber {
namespace {

std::uint32_t point_of(const FiberMotion& motion, std::uint32_t fiber, std::uint32_t segment) {
  return motion.before.offsets()[fiber] + segment;
}

double radius_in(const FiberMotion& motion, std::uint32_t point) {
  return std::max(motion.before.segment_radius(point), motion.after.segment_radius(point));
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
  const Capsule of_a = capsule_at(a, point_of(a, contact.fiber_a, contact.segment_a), time);
  const Capsule of_b = capsule_at(b, point_of(b, contact.fiber_b, contact.segment_b), time);
  Contact found = contact_of(of_a, of_b, segment_distance(of_a.p0, of_a.p1, of_b.p0, of_b.p1));
  found.fiber_a = contact.fiber_a;
  found.segment_a = contact.segment_a;
  found.fiber_b = contact.fiber_b;
  found.segment_b = contact.segment_b;
  return found;
}

std::vector<LastContact> last_contacts(const FiberMotion& a, const FiberMotion& b,
                                       const std::vector<MotionContact>& contacts,
                                       const MotionOptions& options) {
  std::vector<SegmentMotions> backward;
  backward.reserve(contacts.size());
  for (const MotionContact& contact : contacts) {
    const std::uint32_t point_a = point_of(a, contact.fiber_a, contact.segment_a);
    const std::uint32_t point_b = point_of(b, contact.fiber_b, contact.segment_b);
    backward.push_back({&a.after.points()[point_a],
                        &a.before.points()[point_a],
                        &b.after.points()[point_b],
                        &b.before.points()[point_b],
                        {radius_in(a, point_a), radius_in(b, point_b), options.margin}});
  }
  std::vector<ContactTime> times(contacts.size());
  contact_times(backward.data(), backward.size(), options.tolerance, times.data());
  std::vector<LastContact> last;
  last.reserve(times.size());
  for (const ContactTime& time : times) {
    // Near 0 doubles tell more than near 1: outwards to the next one.
    last.push_back(
        {std::isfinite(time.upper) ? std::max(std::nextafter(1.0 - time.upper, 0.0), 0.0) : 0.0,
         std::min(std::nextafter(1.0 - time.lower, 2.0), 1.0),
         time.hit && time.certain && time.upper == 0.0});
  }
  return last;
}

}  // namespace fiber
