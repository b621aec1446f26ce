#pragma once

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "src/sim/contact/natural_log.hpp"

namespace fiber {

/// The potential of a contact by the distance of axes (Li et al. 2020, Eq. 6): none from the outer
/// distance on, infinite at the inner one and below, and smooth in between.
///   b = −k (d − outer)² ln((d − inner) / (outer − inner))
/// Surfaces meet in the middle: fibres begin to push before they touch, and no force brings them
/// further into each other than to the inner distance.
struct Barrier {
  /// Of the distance at which surfaces meet: inner and outer distance are so much less and more.
  static constexpr double half_width = 0.05;

  /// @param touching  distance at which surfaces meet [m]
  /// @param stiffness force by distance where surfaces meet [N/m]
  static Barrier around(double touching, double stiffness) {
    constexpr double curvature_in_middle = 6.386294361119891;  // 5 + 2 ln 2
    return {(1.0 - half_width) * touching, (1.0 + half_width) * touching,
            stiffness / curvature_in_middle};
  }

  /// The same for what begins a step at a distance where the energy would be infinite, as scenes
  /// may make it: it can only part.
  Barrier for_start_at(double distance) const {
    constexpr double spare = 1e-3;
    Barrier barrier = *this;
    barrier.inner = std::min(inner, distance - spare * width());
    return barrier;
  }

  /// A force in parts of what holds surfaces a third of the way from the inner distance to the
  /// outer one.
  double load_of(double force) const {
    constexpr double unit_force = 2.7981;  // of a barrier of 1 N/m and 1 m width there
    return force / (unit_force * scale * width());
  }

  double inner = 0.0;  ///< [m]
  double outer = 0.0;  ///< [m]
  double scale = 0.0;  ///< k [N/m]

  double width() const { return outer - inner; }

  /// A contact with a part of its weight gives way to those that have the rest: it feels only this
  /// share of how far a distance is below the outer one.
  /// @param weight in [0, 1]
  static double depth_share(double weight) { return 1.0 - most_relief * (1.0 - weight); }
  static constexpr double most_relief = 0.28;

  /// The distance that it feels [m].
  double felt(double distance, double weight) const {
    return outer - depth_share(weight) * (outer - distance);
  }

  /// No contact lets a distance fall to this [m].
  double least() const { return outer - width() / (1.0 - most_relief); }

  /// [J]
  double energy(double distance) const {
    if (distance >= outer) {
      return 0.0;
    }
    if (!(distance > inner)) {
      return std::numeric_limits<double>::infinity();
    }
    const double below = distance - outer;
    return -scale * below * below * natural_log((distance - inner) / width());
  }

  /// Its derivatives by the distance, of distances within (inner, outer): never above 0 [N], and
  /// never below 0 [N/m].
  double slope(double distance) const {
    assert(distance > inner && distance < outer);
    const double below = distance - outer;
    const double gap = distance - inner;
    return scale * below * (-2.0 * natural_log(gap / width()) - below / gap);
  }
  double curvature(double distance) const {
    const double ratio = (distance - outer) / (distance - inner);
    return scale * (-2.0 * natural_log((distance - inner) / width()) - 4.0 * ratio + ratio * ratio);
  }
};

/// Rises from 0 to 1 while x does, level at both ends: weights of contacts.
struct Ramp {
  explicit Ramp(double x)
      : value(x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x)),
        slope(x >= 1.0 ? 0.0 : 6.0 * x * (1.0 - x)) {}
  double value;
  double slope;
};

}  // namespace fiber
