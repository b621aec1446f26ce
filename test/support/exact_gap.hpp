#pragma once

#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber::test {

/// The gap of two segments, compared without error.
class Gap {
 public:
  Gap(const Capsule& a, const Capsule& b)
      : a_(a), b_(b), distance_(segment_distance(a.p0, a.p1, b.p0, b.p1)) {}

  bool is_at_most(double limit) const {
    const double gap = value() - limit;
    const double scale = distance_.distance + a_.radius + b_.radius + std::abs(limit);
    if (std::abs(gap) > 16.0 * distance_.error + 1e-14 * scale) {
      return gap < 0.0;  // as integers would say, in a thousandth of their time
    }
    if (limit > known_least_ && limit < known_most_) {
      const bool is = exact_gap_at_most(a_.p0, a_.p1, b_.p0, b_.p1, {a_.radius, b_.radius, limit});
      (is ? known_most_ : known_least_) = limit;
    }
    return limit >= known_most_;
  }
  bool is_at_least(double limit) const {
    return limit == -std::numeric_limits<double>::infinity() ||
           !is_at_most(std::nextafter(limit, -std::numeric_limits<double>::infinity()));
  }

  /// [m] but for its last digits
  double value() const { return distance_.distance - a_.radius - b_.radius; }

 private:
  Capsule a_;
  Capsule b_;
  SegmentDistance distance_;
  mutable double known_most_ = std::numeric_limits<double>::infinity();    // the gap is at most
  mutable double known_least_ = -std::numeric_limits<double>::infinity();  // the gap is more than
};

}  // namespace fiber::test
