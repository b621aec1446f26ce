#include "src/sim/contact/impact.hpp"

#include <algorithm>

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Adds the velocities by an impulse on a point of an edge.
void push(std::uint32_t edge, double parameter, const Vector3d& impulse,
          const std::vector<double>& masses, std::vector<Vector3d>& velocities) {
  velocities[edge] += (1.0 - parameter) / masses[edge] * impulse;
  velocities[edge + 1] += parameter / masses[edge + 1] * impulse;
}

/// The change of a point's velocity by a unit impulse on it [1/kg].
double mobility(std::uint32_t edge, double parameter, const std::vector<double>& masses) {
  return (1.0 - parameter) * (1.0 - parameter) / masses[edge] +
         parameter * parameter / masses[edge + 1];
}

}  // namespace

void resolve(const std::vector<double>& masses, double coefficient, std::vector<Impact>& impacts,
             std::vector<Vector3d>& velocities) {
  constexpr int max_iterations = 200;
  constexpr double max_change = 1e-6;  // of the largest impulse
  for (Impact& impact : impacts) {
    if (!impact.has_begun) {
      impact.separation =
          std::min(0.0, relative_velocity(velocities, impact.points).dot(impact.normal));
    }
  }
  double change = 1.0;
  double largest = 0.0;
  for (int i = 0; i < max_iterations && change > max_change * largest; ++i) {
    change = 0.0;
    for (Impact& impact : impacts) {
      const ContactPoints& points = impact.points;
      const double inverse_mass =
          mobility(points.edge_a, points.s, masses) +
          (points.is_of_rods() ? mobility(points.edge_b, points.t, masses) : 0.0);
      const auto push_both = [&](const Vector3d& impulse) {
        push(points.edge_a, points.s, impulse, masses, velocities);
        if (points.is_of_rods()) {
          push(points.edge_b, points.t, -impulse, masses, velocities);
        }
      };
      const double speed = relative_velocity(velocities, points).dot(impact.normal);
      const double pressure =
          std::max(0.0, impact.pressure + (impact.separation - speed) / inverse_mass);
      push_both((pressure - impact.pressure) * impact.normal);
      const Vector3d velocity = relative_velocity(velocities, points);
      const Vector3d slip = velocity - impact.normal * impact.normal.dot(velocity);
      Vector3d friction = impact.friction - slip / inverse_mass;
      const double max_friction = coefficient * pressure;
      friction *= friction.norm() > max_friction ? max_friction / friction.norm() : 1.0;
      push_both(friction - impact.friction);
      change = std::max(
          {change, std::abs(pressure - impact.pressure), (friction - impact.friction).norm()});
      largest = std::max(largest, pressure);
      impact.pressure = pressure;
      impact.friction = friction;
    }
  }
}

}  // namespace fiber
