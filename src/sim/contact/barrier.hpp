#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// The potential of a contact by the distance of axes: none from the outer distance on, infinite at
/// the inner one and below, and smooth in between. With the part u of the way from the outer to the
/// inner distance,
///   b = k w² (u / (1 − u))³
/// Surfaces meet in the middle: fibres begin to push before they touch, and no force brings them
/// further into each other than to the inner distance.
///
/// It has the part of the barrier of Li et al. 2020 (Eq. 6), whose logarithm pushes with 1 / (1 −
/// u) near the inner distance, where this pushes with 1 / (1 − u)⁴: a force a thousand times that
/// where surfaces meet leaves a ninth of the width, not a thousandth of it, over which the
/// stiffness hardly changes in a step of Newton's method. So one barrier holds the weight of a hair
/// and the pull of a knot, and none has to grow stiffer while it is pressed, which would make
/// energy.
struct Barrier {
  /// The inner and outer distance are below and above the distance at which surfaces meet by this
  /// part of it.
  static constexpr double half_width = 0.05;

  /// @param touching  distance at which surfaces meet [m]
  /// @param stiffness force by distance where surfaces meet [N/m]
  static Barrier around(double touching, double stiffness) {
    constexpr double curvature_in_middle = 144.0;
    return {(1.0 - half_width) * touching, (1.0 + half_width) * touching,
            stiffness / curvature_in_middle};
  }

  /// A barrier whose energy is finite at a distance, for contacts that begin a step below the inner
  /// one, as scenes may make them: they can only part.
  Barrier relaxed_to(double distance) const {
    constexpr double margin = 0.1;
    Barrier barrier = *this;
    barrier.inner = std::min(inner, distance - margin * width());
    return barrier;
  }

  double inner = 0.0;  ///< [m]
  double outer = 0.0;  ///< [m]
  double scale = 0.0;  ///< k [N/m]

  double width() const { return outer - inner; }

  /// A contact with a weight below 1 gives way to those that have the rest: its effective distance
  /// is below the outer one by only this share of what the distance is.
  /// @param weight in [0, 1]
  static double depth_share(double weight) { return 1.0 - max_relief * (1.0 - weight); }
  static constexpr double max_relief = 0.28;

  /// The distance at which a contact with a weight evaluates the barrier [m].
  double effective(double distance, double weight) const {
    return outer - depth_share(weight) * (outer - distance);
  }

  /// No contact lets a distance fall to this [m].
  double min_distance() const { return outer - width() / (1.0 - max_relief); }

  /// The most that an obstacle that moves presses a contact with: ten thousand times the force
  /// where surfaces meet, which leaves a sixteenth of the width [N].
  double max_driven_force() const { return -slope(inner + width() / 16.0); }

  /// [J]
  double energy(double distance) const {
    if (distance >= outer) {
      return 0.0;
    }
    if (!(distance > inner)) {
      return std::numeric_limits<double>::infinity();
    }
    const auto [u, inverse] = depth(distance);
    const double ratio = u * inverse;
    return scale * width() * width() * ratio * ratio * ratio;
  }

  /// The energy's derivatives by the distance, which must be within (inner, outer): the slope is
  /// never positive [N], the curvature never negative [N/m].
  double slope(double distance) const {
    const auto [u, inverse] = depth(distance);
    const double square = inverse * inverse;
    return -3.0 * scale * width() * u * u * square * square;
  }
  double curvature(double distance) const {
    const auto [u, inverse] = depth(distance);
    const double square = inverse * inverse;
    return 6.0 * scale * u * (1.0 + u) * square * square * inverse;
  }

 private:
  /// The part u of the way from the outer to the inner distance, and 1 / (1 − u).
  std::array<double, 2> depth(double distance) const {
    assert(distance > inner && distance < outer);
    return {(outer - distance) / width(), width() / (distance - inner)};
  }
};

/// Rises from 0 to 1 while x does, with slope 0 at both ends: weights of contacts.
struct Smoothstep {
  explicit Smoothstep(double x)
      : value(x >= 1.0 ? 1.0 : x * x * (3.0 - 2.0 * x)),
        slope(x >= 1.0 ? 0.0 : 6.0 * x * (1.0 - x)),
        curvature(x >= 1.0 ? 0.0 : 6.0 - 12.0 * x) {}
  double value;
  double slope;
  double curvature;
};

/// Derivatives of a WeightedBarrier by distances: that of the edge, and then those of its ends,
/// which change the weight.
template <std::size_t ends>
struct WeightedSlopes {
  using Vector = Eigen::Matrix<double, ends + 1, 1>;
  using Square = Eigen::Matrix<double, ends + 1, ends + 1>;

  Vector gradient = Vector::Zero();  ///< [N]
  Square hessian = Square::Zero();   ///< not definite where the weight changes [N/m]
  double pressure = 0.0;             ///< see DistanceTerm [N]
};

/// The barrier of an edge that has only a part of its weight, as its ends have barriers of their
/// own: the weight is a product of smooth steps, each of how much further an end is than the edge.
class WeightedBarrier {
 public:
  /// @param barrier must outlive this
  WeightedBarrier(const Barrier& barrier, double distance, double weight)
      : barrier_(barrier),
        distance_(distance),
        weight_(weight),
        effective_(barrier.effective(distance, weight)),
        energy_(barrier.energy(effective_)) {}

  /// @returns [J], infinite where the effective distance reaches the inner one
  double energy() const { return weight_ * energy_; }

  /// The derivatives, where the energy is finite.
  /// @param steps   the weight's factors, by end
  /// @param cosines of the angles between the normals at ends and the edge's
  template <std::size_t ends>
  WeightedSlopes<ends> slopes(const std::array<Smoothstep, ends>& steps,
                              const std::array<double, ends>& cosines) const {
    using Vector = typename WeightedSlopes<ends>::Vector;
    using Square = typename WeightedSlopes<ends>::Square;
    const double slope = barrier_.slope(effective_);
    const double depth_share = Barrier::depth_share(weight_);
    WeightedSlopes<ends> found;
    found.gradient[0] = weight_ * slope * depth_share;
    found.hessian(0, 0) = weight_ * barrier_.curvature(effective_) * depth_share * depth_share;
    found.pressure = -found.gradient[0];
    if (std::all_of(steps.begin(), steps.end(),
                    [](const auto& step) { return step.slope == 0.0; })) {
      return found;
    }
    // The weight by how much further the ends are, and so by distances.
    Vector weight_by = Vector::Zero();
    Square weight_by_two = Square::Zero();
    for (std::size_t end = 0; end < ends; ++end) {
      const auto row = static_cast<Eigen::Index>(end + 1);
      weight_by[row] = weight_ / steps[end].value * steps[end].slope / barrier_.width();
      weight_by_two(row, row) =
          weight_ / steps[end].value * steps[end].curvature / (barrier_.width() * barrier_.width());
      for (Eigen::Index column = 1; column < row; ++column) {
        weight_by_two(row, column) = weight_by_two(column, row) =
            weight_by[row] * weight_by[column] / weight_;
      }
    }
    weight_by[0] = -weight_by.sum();
    weight_by_two.col(0) = -weight_by_two.rowwise().sum();
    weight_by_two.row(0) = -weight_by_two.colwise().sum();
    // The effective distance by distances.
    const double relief = Barrier::max_relief * (barrier_.outer - distance_);
    Vector effective_by = -relief * weight_by;
    effective_by[0] += depth_share;
    Square effective_by_two = -relief * weight_by_two;
    effective_by_two.col(0) += Barrier::max_relief * weight_by;
    effective_by_two.row(0) += Barrier::max_relief * weight_by.transpose();

    found.gradient = energy_ * weight_by + weight_ * slope * effective_by;
    found.hessian =
        weight_ * barrier_.curvature(effective_) * effective_by * effective_by.transpose() +
        slope * (weight_by * effective_by.transpose() + effective_by * weight_by.transpose()) +
        weight_ * slope * effective_by_two + energy_ * weight_by_two;
    for (std::size_t end = 0; end < ends; ++end) {
      // The force that moves to an end acts along the end's normal, not the edge's.
      found.pressure += found.gradient[static_cast<Eigen::Index>(end + 1)] * (1.0 - cosines[end]);
    }
    return found;
  }

 private:
  const Barrier& barrier_;
  double distance_;   // [m]
  double weight_;     // in [0, 1]
  double effective_;  // distance [m]
  double energy_;     // with weight 1 [J]
};

/// Force by distance where surfaces meet that a rod's material makes natural [N/m]: a contact holds
/// a thousandth of what would stretch the rod to double its length when it is pressed from where
/// its barrier begins to where surfaces meet.
/// @param touching distance at which surfaces meet [m]
inline double material_contact_stiffness(const RodSection& section, double touching) {
  constexpr double share = 1e-3;
  // The force where surfaces meet of a barrier around 1 m of stiffness 1 N/m.
  static const double unit_force = -Barrier::around(1.0, 1.0).slope(1.0);
  return share * section.stretching_stiffness / (unit_force * touching);
}

}  // namespace fiber
