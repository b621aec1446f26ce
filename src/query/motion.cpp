#include "fiber_proximity/query/motion.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/query/for_engines/narrow_phase.hpp"
#include "src/query/motion_evaluator.hpp"

namespace fiber {
namespace {

std::uint32_t point_of(const FiberMotion& motion, std::uint32_t fiber, std::uint32_t segment) {
  return motion.before.offsets()[fiber] + segment;
}

}  // namespace

QueryOptions pairs_of(const MotionOptions& options) {
  QueryOptions pairs;
  static_cast<PairOptions&>(pairs) = static_cast<const PairOptions&>(options);
  return pairs;
}

MotionOptions motion_options(const QueryOptions& options, double tolerance) {
  MotionOptions motion;
  static_cast<PairOptions&>(motion) = static_cast<const PairOptions&>(options);
  motion.tolerance = tolerance;
  if (options.type == QueryType::FIRST || options.type == QueryType::CLOSEST) {
    motion.type = MotionType::FIRST;
  } else if (options.type == QueryType::LIMITED) {
    motion.type = MotionType::LIMITED;
  }
  return motion;
}

void validate(const MotionOptions& options) {
  QueryOptions pairs = pairs_of(options);
  pairs.tolerance = options.tolerance;
  validate(pairs);
  if (!(options.time_tolerance >= 0.0)) {
    throw std::invalid_argument("time_tolerance is " + std::to_string(options.time_tolerance) +
                                ", it must be at least 0 (infinity for none)");
  }
  if (options.type == MotionType::LIMITED && options.max_contacts == 0) {
    throw std::invalid_argument("max_contacts is 0, a limited query needs at least 1");
  }
}

const MotionContact* MotionResult::earliest() const {
  return earliest([](const MotionContact& /*contact*/) { return true; });
}

Capsule capsule_at(const FiberMotion& motion, std::uint32_t point, double time) {
  const auto point_at = [&](std::uint32_t index) -> Eigen::Vector3d {
    return (1.0 - time) * motion.before.points()[index] + time * motion.after.points()[index];
  };
  return {point_at(point), point_at(point + 1), motion.radius(point)};
}

double time_of(const MotionContact& contact) {
  return std::isfinite(contact.upper) ? contact.upper : contact.lower;
}

Contact first_contact(const FiberMotion& a, const FiberMotion& b, const MotionContact& contact) {
  const double time = time_of(contact);
  const Capsule of_a = capsule_at(a, point_of(a, contact.fiber_a, contact.segment_a), time);
  const Capsule of_b = capsule_at(b, point_of(b, contact.fiber_b, contact.segment_b), time);
  Contact found = contact_of(of_a, of_b, segment_distance(of_a.p0, of_a.p1, of_b.p0, of_b.p1));
  static_cast<SegmentIdPair&>(found) = static_cast<const SegmentIdPair&>(contact);
  return found;
}

std::vector<LastContact> last_contacts(const FiberMotion& a, const FiberMotion& b,
                                       const std::vector<MotionContact>& contacts,
                                       const MotionOptions& options) {
  std::vector<SegmentMotions> backward;
  backward.reserve(contacts.size());
  for (const MotionContact& contact : contacts) {
    const PointPair pair{point_of(a, contact.fiber_a, contact.segment_a),
                         point_of(b, contact.fiber_b, contact.segment_b)};
    backward.push_back(motions_of({a.after, a.before}, {b.after, b.before}, pair, options.margin));
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
