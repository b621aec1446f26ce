// The part of a solve that gives impacts their restitution, see Impact.

#include <algorithm>
#include <cmath>

#include "src/sim/solver/newton.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The largest part, up to 1, of a change of velocities that adds no more kinetic energy than is
/// allowed.
double allowed_share(const std::vector<double>& masses, const std::vector<Vector3d>& before,
                     const std::vector<Vector3d>& after, const std::vector<std::uint32_t>& nodes,
                     double allowed) {
  double linear = 0.0;  // the energy by the share y is y linear + y² square
  double square = 0.0;
  for (const std::uint32_t node : nodes) {
    const Vector3d change = after[node] - before[node];
    linear += masses[node] * before[node].dot(change);
    square += 0.5 * masses[node] * change.squaredNorm();
  }
  if (linear + square <= allowed) {
    return 1.0;
  }
  return (std::sqrt(linear * linear + 4.0 * square * allowed) - linear) / (2.0 * square);
}

}  // namespace

/// Kinetic energy of the rods at their velocities, by island [J].
std::vector<double> NewtonSolver::kinetic_energies(const Rods& rods) const {
  std::vector<double> energies(states_.size(), 0.0);
  for (const std::uint32_t rod : members_) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      double& energy = energies[scratch_->islands[rod]];
      energy += 0.5 * rods.masses[i] * rods.velocities[i].squaredNorm();
      if (!rods.spins.empty()) {
        const double inertia = rods.sections[rod].inertia_per_length * rods.rest_lengths[i];
        energy += 0.5 * inertia * rods.spins[i] * rods.spins[i];
      }
    }
  }
  return energies;
}

/// Changes the velocities by the impacts of each island, which give back no more energy than the
/// solve has taken.
void NewtonSolver::resolve_impacts(Rods& rods, const Problem& problem,
                                   const std::vector<Impact>& impacts) {
  const double coefficient = problem.friction != nullptr ? problem.friction->coefficient() : 0.0;
  const std::vector<double> kinetic = kinetic_energies(rods);
  for (std::uint32_t island = 0; island < states_.size(); ++island) {
    std::vector<Impact> own;
    std::vector<std::uint32_t> nodes;
    for (const Impact& impact : impacts) {
      if (scratch_->islands[impact.points.rod_a] == island) {
        own.push_back(impact);
        nodes.insert(nodes.end(), {impact.points.edge_a, impact.points.edge_a + 1});
        if (impact.points.is_of_rods()) {
          nodes.insert(nodes.end(), {impact.points.edge_b, impact.points.edge_b + 1});
        }
      }
    }
    if (std::none_of(own.begin(), own.end(), [](const auto& impact) { return impact.has_begun; })) {
      continue;
    }
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<Vector3d>& before = scratch_->displacements;
    for (const std::uint32_t node : nodes) {
      before[node] = rods.velocities[node];
    }
    resolve(rods.masses, coefficient, own, rods.velocities);
    const double share = allowed_share(rods.masses, before, rods.velocities, nodes,
                                       std::max(0.0, max_kinetic_[island] - kinetic[island]));
    for (const std::uint32_t node : nodes) {
      rods.velocities[node] = before[node] + share * (rods.velocities[node] - before[node]);
    }
    for (Impact& impact : own) {
      impact.pressure *= share;
      impact.friction *= share;
    }
    problem.contacts->add_impacts(own);
    reports_[island].impacts = static_cast<std::uint32_t>(own.size());
  }
}

}  // namespace fiber
