#pragma once

#include <cstdint>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "validation/geometry/hard_motions.hpp"

namespace fiber {

/// How answers about moving capsules compare with the truth.
struct MotionScore {
  std::uint64_t motions = 0;
  std::uint64_t hits = 0;
  std::uint64_t certain = 0;          ///< of the hits
  std::uint64_t without_upper = 0;    ///< hits for which no time of contact was found
  std::uint64_t misses = 0;           ///< a contact before `lower`, or one without a hit
  std::uint64_t false_alarms = 0;     ///< a gap of more than the tolerance at `upper`
  std::uint64_t wrongly_certain = 0;  ///< no contact until `upper` all the same
  std::uint64_t wide = 0;             ///< fast contacts: upper − lower is more than 20 T/L
  std::uint64_t undecided = 0;        ///< of which the truth could not be found

  bool has_wrong_answers() const { return misses + false_alarms + wrongly_certain + wide > 0; }
  MotionScore& operator+=(const MotionScore& more);
};

/// Judges the answer to one motion by MotionOracle.
MotionScore judge(const HardMotion& motion, double tolerance, const ContactTime& answer);

/// The largest difference of coordinates between points of the two capsules [m].
double extent_of(const HardMotion& motion);

}  // namespace fiber
