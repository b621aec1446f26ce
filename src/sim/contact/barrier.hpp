#pragma once

#include <cmath>
#include <limits>

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

  /// The same for what begins a step at a distance: nearer than the inner one, as scenes may make
  /// it, it can only part. Otherwise as it is.
  Barrier for_start_at(double distance) const {
    constexpr double most_share = 0.9;
    Barrier barrier = *this;
    if (!(distance > inner)) {
      barrier.inner =
          distance > 0.0 ? most_share * distance : distance - (1.0 - most_share) * inner;
    }
    return barrier;
  }

  double inner = 0.0;  ///< [m]
  double outer = 0.0;  ///< [m]
  double scale = 0.0;  ///< k [N/m]

  double width() const { return outer - inner; }

  /// [J]
  double energy(double distance) const {
    if (distance >= outer) {
      return 0.0;
    }
    if (!(distance > inner)) {
      return std::numeric_limits<double>::infinity();
    }
    const double below = distance - outer;
    return -scale * below * below * std::log((distance - inner) / width());
  }

  /// Its derivatives by the distance, of distances within (inner, outer): never above 0 [N], and
  /// never below 0 [N/m].
  double slope(double distance) const {
    const double below = distance - outer;
    const double gap = distance - inner;
    return scale * below * (-2.0 * std::log(gap / width()) - below / gap);
  }
  double curvature(double distance) const {
    const double ratio = (distance - outer) / (distance - inner);
    return scale * (-2.0 * std::log((distance - inner) / width()) - 4.0 * ratio + ratio * ratio);
  }
};

}  // namespace fiber
