#pragma once

#include <Eigen/Core>
#include <limits>

namespace fiber {

/// Bounds the gap that two segments had before they moved. Grows with the gap by now, at least as
/// fast.
class Approach {
 public:
  Approach() = default;

  /// @param moved [m] the way of both together
  explicit Approach(double moved) : offset_(moved) {}

  /// Two that move as a field does, but for a way [m] that both have together. Points of them that
  /// are d apart now were at most (d + way) / (1 − rate) apart.
  /// @param rate      a Lipschitz constant of the field
  /// @param thickness [m] most of two radii together
  Approach(double way, double rate, double thickness) {
    // Rounded up; that of the gap, which may be less than 0, as well.
    constexpr double epsilon = 8.0 * std::numeric_limits<double>::epsilon();
    constexpr double infinity = std::numeric_limits<double>::infinity();
    factor_ = rate < 1.0 ? (1.0 + epsilon) / (1.0 - rate) : 1.0;
    offset_ = rate < 1.0 ? (1.0 + epsilon) * factor_ * (way + (rate + 2.0 * epsilon) * thickness)
                         : infinity;
  }

  /// [m] For that of the surfaces by now. Infinite where nothing is known.
  double before(double gap) const { return factor_ * gap + offset_; }

  bool is_none() const { return factor_ == 1.0 && offset_ == 0.0; }

 private:
  double factor_ = 1.0;
  double offset_ = 0.0;  // [m]
};

/// Bounds on how far fibres have moved.
struct MotionSinceFit {
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();  ///< [m] what they have in common
  double beyond = 0.0;                              ///< [m] of any point, the drift apart
  Approach approach;

  /// Each point by at most so much [m].
  static MotionSinceFit within(double moved) {
    return {Eigen::Vector3d::Zero(), moved, Approach(2.0 * moved)};
  }
  static MotionSinceFit unknown() { return within(std::numeric_limits<double>::infinity()); }

  bool is_known() const { return beyond < std::numeric_limits<double>::infinity(); }

  /// Whether all pairs that are within this margin by now were within margin and skin before [m].
  bool leaves(double skin, double margin) const { return approach.before(margin) <= margin + skin; }
};

}  // namespace fiber
