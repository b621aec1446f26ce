#pragma once

#include "fiber_proximity/sim/contact_source.hpp"

namespace fiber {

/// Coulomb's friction in every contact: against the sliding of the surfaces, up to the coefficient
/// times the normal force. What sticks creeps at less than a set speed, which makes it a potential
/// of the step (Li et al. 2020, Sect. 5); normal forces, directions and places are those of the
/// last iteration.
class Friction {
 public:
  struct Options {
    double coefficient = 0.3;
    double stick_speed = 1e-3;  ///< [m/s]
  };

  /// @throws std::invalid_argument naming the value, for a coefficient that is negative or not
  ///         finite, or a speed that is not positive and finite
  explicit Friction(const Options& options);

  void begin_step(const Rods& rods, const TimeStep& step);

  /// How far a touches has slid along b in this step [m].
  Eigen::Vector3d slip(const Rods& rods, const ContactPoint& point) const;

  /// Energy of a contact's friction [J].
  double energy(const ContactPoint& point, const Eigen::Vector3d& slip) const;

  /// Its gradient by the slip is this times the slip, and its Hessian at most this [N/m].
  double resistance(const ContactPoint& point, const Eigen::Vector3d& slip) const;

 private:
  Options options_;
  double stick_length_ = 0.0;               // [m] what creeps in a step sticks
  std::vector<Eigen::Vector3d> beginning_;  // positions of the nodes
};

}  // namespace fiber
