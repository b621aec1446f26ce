#include "fiber_proximity/sim/effects/twist.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fiber_proximity/sim/edge_pair.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

void validate(const RodSection& section, std::uint32_t rod) {
  if (!(section.twisting_stiffness > 0.0 && section.inertia_per_length > 0.0)) {
    throw std::invalid_argument("twist: rod " + std::to_string(rod) +
                                " needs a twisting stiffness and an inertia per length above 0");
  }
}

}  // namespace

Vector3d current_director(const Rods& rods, std::uint32_t edge) {
  return transport(rods.directors[edge], rods.start_tangents[edge],
                   edge_direction(rods, edge).tangent);
}

double signed_angle(const Vector3d& from, const Vector3d& to, const Vector3d& about) {
  return std::atan2(about.dot(from.cross(to)), from.dot(to));
}

double nearest_turn(double angle, double to) {
  const double turn = 2.0 * M_PI;
  return angle - turn * std::round((angle - to) / turn);
}

Vector3d curvature_binormal(const Vector3d& tangent_before, const Vector3d& tangent_after) {
  constexpr double folded = 1e-3;
  return 2.0 * tangent_before.cross(tangent_after) /
         std::max(folded, 1.0 + tangent_before.dot(tangent_after));
}

Vector3d director_turn(const Vector3d& start_tangent, const EdgeDirection& edge) {
  return curvature_binormal(start_tangent, edge.tangent) / (-2.0 * edge.length);
}

Twist::Twist(Rods& rods) : reference_twists_(rods.positions.size()) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    validate(rods.sections[rod], rod);
  }
  rods.directors.resize(rods.positions.size(), Vector3d::Zero());
  rods.start_tangents.resize(rods.positions.size(), Vector3d::Zero());
  rods.angles.resize(rods.positions.size(), 0.0);
  rods.spins.resize(rods.positions.size(), 0.0);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const Vector3d tangent = edge_direction(rods, i).tangent;
      rods.directors[i] = i == rods.first(rod) ? tangent.unitOrthogonal()
                                               : transport(rods.directors[i - 1],
                                                           rods.start_tangents[i - 1], tangent);
      rods.start_tangents[i] = tangent;
    }
  }
}

double Twist::twist_at(const Rods& rods, std::uint32_t node) const {
  const Vector3d before = edge_direction(rods, node - 1).tangent;
  const Vector3d after = edge_direction(rods, node).tangent;
  const Vector3d carried = transport(current_director(rods, node - 1), before, after);
  const double reference = signed_angle(carried, current_director(rods, node), after);
  return rods.angles[node] - rods.angles[node - 1] +
         nearest_turn(reference, reference_twists_[node]);
}

double Twist::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
    const double twist = twist_at(rods, i);
    energy += twist * twist / rods.rest_length_at(i);
  }
  return 0.5 * rods.sections[rod].twisting_stiffness * energy;
}

void Twist::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  const std::uint32_t first = rods.first(rod);
  for (std::uint32_t i = first + 1; i + 1 < rods.end(rod); ++i) {
    const EdgeDirection before = edge_direction(rods, i - 1);
    const EdgeDirection after = edge_direction(rods, i);
    const Vector3d binormal = curvature_binormal(before.tangent, after.tangent);
    const Vector3d by_previous =
        director_turn(rods.start_tangents[i - 1], before) - binormal / (2.0 * before.length);
    const Vector3d by_next =
        director_turn(rods.start_tangents[i], after) + binormal / (2.0 * after.length);
    const double stiffness = rods.sections[rod].twisting_stiffness / rods.rest_length_at(i);
    const double moment = stiffness * twist_at(rods, i);
    const std::uint32_t node = i - first;
    system.add_gradient(node - 1, moment * by_previous);
    system.add_gradient(node, -moment * (by_previous + by_next));
    system.add_gradient(node + 1, moment * by_next);
    system.add_angle_gradient(node - 1, -moment);
    system.add_angle_gradient(node, moment);

    // The derivative of the twist by all unknowns from the previous node to the next one.
    Eigen::Matrix<double, 11, 1> by_all;
    by_all << by_previous, -1.0, -(by_previous + by_next), 1.0, by_next;
    const std::size_t start = std::size_t{node - 1} * system.unknowns();
    for (Eigen::Index c = 0; c < by_all.size(); ++c) {
      for (Eigen::Index r = c; r < by_all.size(); ++r) {
        system.add_hessian_entry(start + r, start + c, stiffness * by_all[r] * by_all[c]);
      }
    }
  }
}

void Twist::end_step(Rods& rods, const TimeStep& /*step*/) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const Vector3d tangent = edge_direction(rods, i).tangent;
      const Vector3d director = transport(rods.directors[i], rods.start_tangents[i], tangent);
      // Rounding errors of many steps would let it lean and grow.
      rods.directors[i] = (director - tangent * tangent.dot(director)).normalized();
      if (tangent.squaredNorm() > 0.0) {
        rods.start_tangents[i] = tangent;
      }
      if (i > rods.first(rod)) {
        const Vector3d carried =
            transport(rods.directors[i - 1], rods.start_tangents[i - 1], tangent);
        reference_twists_[i] =
            nearest_turn(signed_angle(carried, rods.directors[i], tangent), reference_twists_[i]);
      }
    }
  }
}

}  // namespace fiber
