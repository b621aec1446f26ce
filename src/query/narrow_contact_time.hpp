#pragma once

#include <algorithm>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/query/motion.hpp"

namespace fiber {

/// Brings the bounds of a certain contact nearer to each other, to MotionOptions::time_tolerance,
/// by asking again with smaller and smaller tolerances: what is proven with any of them holds.
/// @param ask for the pair's ContactTime with a tolerance [m]
template <class Ask>
void narrow(ContactTime& time, const MotionOptions& options, const Ask& ask) {
  constexpr int most_questions = 6;
  constexpr double factor = 0x1p-8;
  double tolerance = factor * options.tolerance;
  for (int i = 0; i < most_questions && time.certain && tolerance > 0.0 &&
                  time.upper - time.lower > options.time_tolerance;
       ++i, tolerance *= factor) {
    const ContactTime again = ask(tolerance);
    if (again.hit) {
      time.lower = std::max(time.lower, again.lower);
    }
    if (again.hit && again.certain) {
      time.upper = std::min(time.upper, again.upper);
    }
  }
}

}  // namespace fiber
