#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// The natural logarithm of a positive, finite number, to some units of the last digit: unlike the
/// standard library's the same on all processors. Without a call or a chain of eleven products, for
/// contacts ask for it all the time.
inline double natural_log(double x) {
  constexpr double root_of_half = 0.7071067811865476;
  constexpr double log_of_two = 0.6931471805599453;
  constexpr int mantissa_bits = 52;
  constexpr std::uint64_t mantissa = (std::uint64_t{1} << mantissa_bits) - 1;
  constexpr std::uint64_t half = std::uint64_t{0x3fe} << mantissa_bits;
  const bool is_subnormal = x < std::numeric_limits<double>::min();
  x *= is_subnormal ? 0x1p54 : 1.0;
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof bits);
  int exponent = static_cast<int>(bits >> mantissa_bits) - 0x3fe - (is_subnormal ? 54 : 0);
  bits = (bits & mantissa) | half;
  double fraction = 0.0;  // in [1/2, 1)
  std::memcpy(&fraction, &bits, sizeof fraction);
  if (fraction < root_of_half) {
    fraction *= 2.0;
    --exponent;
  }
  // ln f = 2 artanh z, of |z| < 0.172
  const double z = (fraction - 1.0) / (fraction + 1.0);
  const double z2 = z * z;
  const double z4 = z2 * z2;
  const double z8 = z4 * z4;
  const double first = (1.0 + z2 * (1.0 / 3.0)) + z4 * (1.0 / 5.0 + z2 * (1.0 / 7.0));
  const double second = (1.0 / 9.0 + z2 * (1.0 / 11.0)) + z4 * (1.0 / 13.0 + z2 * (1.0 / 15.0));
  const double third = (1.0 / 17.0 + z2 * (1.0 / 19.0)) + z4 * (1.0 / 21.0);
  return exponent * log_of_two + 2.0 * z * (first + z8 * (second + z8 * third));
}

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

/// Derivatives of a WeightedBarrier by the edge's distance and, as they change the weight, by those
/// of its ends.
template <std::size_t ends>
struct WeightedSlopes {
  double slope = 0.0;      ///< [N]
  double curvature = 0.0;  ///< a positive part [N/m]
  double pressure = 0.0;   ///< see DistanceTerm [N]
  std::array<double, ends> end_slopes{};
  std::array<double, ends> end_curvatures{};
};

/// The barrier of an edge that has only a part of its weight, as its ends have barriers of their
/// own: the weight is the product of ramps, each of how much further an end is than the edge.
class WeightedBarrier {
 public:
  /// @param barrier must outlive this
  WeightedBarrier(const Barrier& barrier, double distance, double weight)
      : barrier_(barrier),
        distance_(distance),
        weight_(weight),
        felt_(barrier.felt(distance, weight)),
        energy_(barrier.energy(felt_)) {}

  /// @returns [J], infinite where what is felt reaches the inner distance
  double energy() const { return weight_ * energy_; }

  /// Where the energy is finite.
  /// @param ramps   of each end, in parts of the barrier's width
  /// @param cosines of the angles between the normals at ends and the edge's
  template <std::size_t ends>
  WeightedSlopes<ends> slopes(const std::array<Ramp, ends>& ramps,
                              const std::array<double, ends>& cosines) const {
    const double by_felt = weight_ * barrier_.slope(felt_);
    const double by_felt_twice = weight_ * barrier_.curvature(felt_);
    const double depth_share = Barrier::depth_share(weight_);
    const double by_weight =
        energy_ - by_felt * Barrier::most_relief * (barrier_.outer - distance_);
    WeightedSlopes<ends> found;
    found.slope = by_felt * depth_share;
    found.pressure = -found.slope;
    // How what is felt changes with the distance, and with those of the ends, by the weight.
    const double relief = Barrier::most_relief * (barrier_.outer - distance_);
    std::array<double, ends> felt_by_end{};
    double felt_by_ends = 0.0;
    for (std::size_t end = 0; end < ends; ++end) {
      if (ramps[end].slope > 0.0) {
        const double weight_by_end =
            weight_ / ramps[end].value * ramps[end].slope / barrier_.width();
        felt_by_end[end] = relief * weight_by_end;
        felt_by_ends += felt_by_end[end];
        found.end_slopes[end] = by_weight * weight_by_end;
        found.slope -= found.end_slopes[end];
        // What an end takes back is not along the same normal.
        found.pressure += found.end_slopes[end] * (1.0 - cosines[end]);
      }
    }
    // The square of the sum of these is no more than this sum of squares.
    const double of_distance = depth_share + felt_by_ends;
    const double all = of_distance + felt_by_ends;
    found.curvature = by_felt_twice * of_distance * all;
    for (std::size_t end = 0; end < ends; ++end) {
      found.end_curvatures[end] = by_felt_twice * felt_by_end[end] * all;
    }
    return found;
  }

 private:
  const Barrier& barrier_;
  double distance_;  // [m]
  double weight_;    // in [0, 1]
  double felt_;      // [m]
  double energy_;    // [J] of the whole weight
};

/// Force by distance where surfaces meet that a rod's material makes natural [N/m]: a contact holds
/// a thousandth of what would stretch the rod to double its length when it is pressed from where
/// its barrier begins to where surfaces meet.
/// @param touching distance at which surfaces meet [m]
inline double material_contact_stiffness(const RodSection& section, double touching) {
  constexpr double share = 1e-3;
  // A barrier around 1 m that has the stiffness 1 N/m where surfaces meet holds so much there.
  static const double unit_force = -Barrier::around(1.0, 1.0).slope(1.0);
  return share * section.stretching_stiffness / (unit_force * touching);
}

}  // namespace fiber
