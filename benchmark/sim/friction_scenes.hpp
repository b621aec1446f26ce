#pragma once

#include <memory>

#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// A rod across a plane of this slope, at rest, that slides or creeps down.
class Incline {
 public:
  /// @param angle    [rad]
  /// @param friction coefficient
  Incline(double angle, double friction);

  /// @param time [s]
  void run(double time);

  /// Of the whole rod, downwards [m/s].
  double speed() const;

 private:
  Eigen::Vector3d down_;
  std::unique_ptr<Stepper> stepper_;
};

/// A rope without bending stiffness around a post along z: which part of a turn, in how many edges.
struct Capstan {
  double turns;
  int edges_per_turn;
};

/// Ratio of the tensions beyond and before a post over which a rope is pulled, with its first node
/// loaded.
double tension_ratio(const Capstan& capstan, double friction);

}  // namespace fiber
