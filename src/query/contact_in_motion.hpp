#pragma once

#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/motion_evaluator.hpp"

namespace fiber {

/// A segment at a part of the motion, of the larger of its radii.
/// @param point its first one
Capsule capsule_at(const FiberMotion& motion, std::uint32_t point, double time);

/// The time at which a MotionContact is looked at: its `upper`, or `lower` where there is none.
double time_of(const MotionContact& contact);

/// The pair of a MotionContact as it is at time_of() it: distance, nearest points and normal as a
/// robust query about the fibres of that time has them.
/// @param a, b of the first and of the second segment, the same for fibres with each other
Contact first_contact(const FiberMotion& a, const FiberMotion& b, const MotionContact& contact);

/// When a pair is in contact for the last time, as parts of the motion.
struct LastContact {
  double lower = 0.0;  ///< the gap is at most margin + tolerance at this time
  double upper = 1.0;  ///< after this there is no contact
  bool lasts = true;   ///< they are in contact at the end of the motion, decided exactly
};

/// Looks at a motion from its end for pairs that come into contact in it.
/// @param options margin and tolerance count
/// @returns one for each contact
std::vector<LastContact> last_contacts(const FiberMotion& a, const FiberMotion& b,
                                       const std::vector<MotionContact>& contacts,
                                       const MotionOptions& options);

}  // namespace fiber
