#include "src/sim/contact/impact.hpp"

#include <algorithm>
#include <cmath>

#include "src/sim/inertia.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// One side of an impact: a point of an edge, and where friction acts beside it.
struct Side {
  std::uint32_t rod;
  std::uint32_t edge;
  double parameter;
  const SurfaceLever* lever;  // null: on the axis
};

Side side_a(const Impact& impact) {
  const ContactPoints& points = impact.points;
  return {points.rod_a, points.edge_a, points.s, impact.levers ? &impact.levers->front() : nullptr};
}

Side side_b(const Impact& impact) {
  const ContactPoints& points = impact.points;
  return {points.rod_b, points.edge_b, points.t, impact.levers ? &impact.levers->back() : nullptr};
}

/// Adds the velocities by an impulse on a point of an edge.
void push(const Side& side, const Vector3d& impulse, Rods& rods) {
  const std::uint32_t edge = side.edge;
  change_velocity(rods, edge, (1.0 - side.parameter) / mass_against_impulse(rods, edge) * impulse);
  change_velocity(rods, edge + 1, side.parameter / mass_against_impulse(rods, edge + 1) * impulse);
}

/// Adds the velocities and the spin by an impulse where friction acts.
void push_across(const Side& side, const Vector3d& impulse, Rods& rods) {
  if (side.lever == nullptr) {
    push(side, impulse, rods);
  } else {
    const Eigen::Matrix<double, SurfaceLever::unknowns, 1> by_all =
        side.lever->jacobian(side.parameter).transpose() * impulse;
    change_velocity(rods, side.edge, by_all.head<3>() / mass_against_impulse(rods, side.edge));
    change_velocity(rods, side.edge + 1,
                    by_all.tail<3>() / mass_against_impulse(rods, side.edge + 1));
    rods.spins[side.edge] += by_all[3] / rods.section_inertia(side.rod, side.edge);
  }
}

/// The change of the velocity of a point of an edge by a unit impulse on it [1/kg].
double mobility(const Side& side, const Rods& rods) {
  const double first = 1.0 - side.parameter;
  const double second = side.parameter;
  return first * first / mass_against_impulse(rods, side.edge) +
         second * second / mass_against_impulse(rods, side.edge + 1) +
         2.0 * first * second * coupled_mobility(rods, side.edge);
}

/// The change of the velocity of the point where friction acts by an impulse there [1/kg].
Matrix3d lever_mobility(const Side& side, const Rods& rods) {
  const SurfaceLever::Jacobian jacobian = side.lever->jacobian(side.parameter);
  const auto of_nodes = [&](int column, std::uint32_t node) -> Matrix3d {
    return jacobian.middleCols<3>(column) * jacobian.middleCols<3>(column).transpose() /
           mass_against_impulse(rods, node);
  };
  const Matrix3d mixed = jacobian.middleCols<3>(0) * jacobian.middleCols<3>(4).transpose();
  return of_nodes(0, side.edge) + of_nodes(4, side.edge + 1) +
         coupled_mobility(rods, side.edge) * (mixed + mixed.transpose()) +
         jacobian.col(3) * jacobian.col(3).transpose() / rods.section_inertia(side.rod, side.edge);
}

/// How fast an impact's sides move against each other by unit impulses on them, at most [1/kg].
struct Mobilities {
  double along;   // the normal
  double across;  // where friction acts
};

Mobilities mobilities(const Impact& impact, const Rods& rods) {
  const bool is_of_rods = impact.points.is_of_rods();
  const double along =
      mobility(side_a(impact), rods) + (is_of_rods ? mobility(side_b(impact), rods) : 0.0);
  if (!impact.levers) {
    return {along, along};
  }
  Matrix3d both = lever_mobility(side_a(impact), rods);
  if (is_of_rods) {
    both += lever_mobility(side_b(impact), rods);
  }
  // The larger of the two eigenvalues in the plane of contact.
  const Matrix3d plane = Matrix3d::Identity() - impact.normal * impact.normal.transpose();
  const Matrix3d in_plane = plane * both * plane;
  const double trace = in_plane.trace();
  const double root = std::sqrt(std::max(0.0, 2.0 * in_plane.squaredNorm() - trace * trace));
  return {along, 0.5 * (trace + root)};
}

/// The velocity with which the sides slide on each other where friction acts [m/s].
Vector3d slip_velocity(const Impact& impact, const Rods& rods) {
  Vector3d velocity =
      difference_of_points(rods.velocities, impact.points) - impact.obstacle_velocity;
  if (impact.levers) {
    velocity += lever_motion(*impact.levers, impact.points, rods.velocities, rods.spins);
  }
  return velocity - impact.normal * impact.normal.dot(velocity);
}

/// The speed with which the sides part [m/s].
double speed_along(const Impact& impact, const Rods& rods) {
  return (difference_of_points(rods.velocities, impact.points) - impact.obstacle_velocity)
      .dot(impact.normal);
}

/// The part of a vector that is no longer than that.
Vector3d within(const Vector3d& vector, double max_length) {
  const double length = vector.norm();
  return length > max_length ? Vector3d(max_length / length * vector) : vector;
}

}  // namespace

bool is_returning(const Impact& impact, const Rods& rods) {
  return impact.returnable > 0.0 &&
         speed_along(impact, rods) > impact.max_separation + Impact::min_returned_speed;
}

void resolve(Rods& rods, double coefficient, std::vector<Impact>& impacts) {
  constexpr int max_iterations = 200;
  constexpr double max_change = 1e-6;  // of the largest impulse
  std::vector<Mobilities> by_impact;
  for (Impact& impact : impacts) {
    by_impact.push_back(mobilities(impact, rods));
    if (!impact.has_begun) {
      impact.separation = std::min(0.0, speed_along(impact, rods));
    }
  }
  double change = 1.0;
  double largest = 0.0;
  for (int i = 0; i < max_iterations && change > max_change * largest; ++i) {
    change = 0.0;
    for (std::size_t index = 0; index < impacts.size(); ++index) {
      Impact& impact = impacts[index];
      const Mobilities& sides = by_impact[index];
      const auto on_both = [&](const auto& push_side, const Vector3d& impulse) {
        push_side(side_a(impact), impulse, rods);
        if (impact.points.is_of_rods()) {
          push_side(side_b(impact), -impulse, rods);
        }
      };
      const double speed = speed_along(impact, rods);
      const double parting = impact.pressure + (impact.separation - speed) / sides.along;
      const double kept = impact.pressure + (impact.max_separation - speed) / sides.along;
      const double pressure = std::max(-impact.returnable, std::clamp(0.0, parting, kept));
      if (pressure == 0.0 && impact.pressure == 0.0 && impact.friction == Vector3d::Zero()) {
        continue;  // as of most contacts of an island that is struck
      }
      on_both(push, (pressure - impact.pressure) * impact.normal);
      const Vector3d friction =
          pressure < 0.0 ? Vector3d(within(impact.step_friction,
                                           coefficient * (impact.returnable + pressure)) -
                                    impact.step_friction)
                         : within(impact.friction - slip_velocity(impact, rods) / sides.across,
                                  coefficient * pressure);
      on_both(push_across, friction - impact.friction);
      change = std::max(
          {change, std::abs(pressure - impact.pressure), (friction - impact.friction).norm()});
      largest = std::max(largest, pressure);
      impact.pressure = pressure;
      impact.friction = friction;
    }
  }
}

}  // namespace fiber
