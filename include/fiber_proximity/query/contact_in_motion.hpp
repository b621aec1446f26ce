#pragma once

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/motion_judge.hpp"

namespace fiber {

/// The pair of a MotionContact as it is at its MotionContact::upper, or at `lower` where no such
/// time was found: distance, nearest points and normal as a robust query about the fibres of that
/// time has them.
/// @param a, b of the first and of the second segment, the same for fibres with each other
Contact first_contact(const FiberMotion& a, const FiberMotion& b, const MotionContact& contact);

/// When a pair is in contact for the last time, as parts of the motion.
struct LastContact {
  double lower = 0.0;  ///< the gap is at most margin + tolerance at this time
  double upper = 1.0;  ///< after this there is no contact
  bool lasts = true;   ///< they are in contact at the end of the motion, decided exactly
};

/// Looks at a motion from its end for a pair that comes into contact in it.
/// @param options margin and tolerance count
LastContact last_contact(const FiberMotion& a, const FiberMotion& b, const MotionContact& contact,
                         const MotionOptions& options);

}  // namespace fiber
