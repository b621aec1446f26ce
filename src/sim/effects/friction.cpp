#include "fiber_proximity/sim/effects/friction.hpp"

#include "../require.hpp"

namespace fiber {

using Eigen::Vector3d;

Friction::Friction(const Options& options) : options_(options) {
  require_not_negative("friction: the coefficient", options.coefficient);
  require_positive("friction: the stick speed", options.stick_speed, " m/s");
}

void Friction::begin_step(const Rods& rods, const TimeStep& step) {
  stick_length_ = options_.stick_speed * step.length;
  beginning_ = rods.positions;
}

Vector3d Friction::slip(const Rods& rods, const ContactPoint& point) const {
  const auto moved = [&](std::uint32_t edge, double parameter) -> Vector3d {
    return (1.0 - parameter) * (rods.positions[edge] - beginning_[edge]) +
           parameter * (rods.positions[edge + 1] - beginning_[edge + 1]);
  };
  Vector3d relative = moved(point.edge_a, point.s);
  if (!point.is_obstacle()) {
    relative -= moved(point.edge_b, point.t);
  }
  return relative - point.normal * point.normal.dot(relative);
}

// With the largest force f and the stick length e, the force is f (2 y/e - y²/e²) for slips y below
// e, and f above: continuous, with a continuous derivative.

double Friction::energy(const ContactPoint& point, const Vector3d& slip) const {
  const double most = options_.coefficient * point.stiffness * point.depth;
  const double share = slip.norm() / stick_length_;
  return most * stick_length_ *
         (share < 1.0 ? share * share * (1.0 - share / 3.0) : share - 1.0 / 3.0);
}

double Friction::resistance(const ContactPoint& point, const Vector3d& slip) const {
  const double most = options_.coefficient * point.stiffness * point.depth;
  const double share = slip.norm() / stick_length_;
  return most / stick_length_ * (share < 1.0 ? 2.0 - share : 1.0 / share);
}

}  // namespace fiber
