#include "fiber_proximity/sim/effects/inextensible.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/edge_pair.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Inextensible::Inextensible(const Rods& rods)
    : springs_(rods.positions.size()), found_(rods.positions.size()) {}

void Inextensible::begin_step(Rods& rods, const TimeStep& step) {
  // Far stiffer than inertia, and yet of a magnitude that rounding errors can bear.
  constexpr double ratio = 1e4;
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    springs_[i].stiffness = ratio * rods.masses[i] / (step.length * step.length);
  }
}

double Inextensible::force(const Rods& rods, std::uint32_t edge, double length) const {
  const Spring& spring = springs_[edge];
  return spring.tension + spring.stiffness * (length - rods.rest_lengths[edge]);
}

const double* Inextensible::values_of(std::uint32_t node) const {
  static_assert(sizeof(Spring) == 2 * sizeof(double));
  return &springs_[node].tension;
}

double Inextensible::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
    const double excess = edge_direction(rods, i).length - rods.rest_lengths[i];
    energy += (springs_[i].tension + 0.5 * springs_[i].stiffness * excess) * excess;
  }
  return energy;
}

void Inextensible::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  const std::uint32_t first = rods.first(rod);
  for (std::uint32_t i = first; i + 1 < rods.end(rod); ++i) {
    const EdgeDirection edge = edge_direction(rods, i);
    const double force = this->force(rods, i, edge.length);
    const Matrix3d along = edge.tangent * edge.tangent.transpose();
    // As in Stretch, without what gives way under pressure.
    const Matrix3d block = springs_[i].stiffness * along +
                           std::max(0.0, force) / edge.length * (Matrix3d::Identity() - along);
    system.add_edge(i - first, force * edge.tangent, block);
  }
}

void Inextensible::end_solve(const Rods& rods, std::uint32_t rod) {
  constexpr double learnt_from = 0.01;  // largest strain
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
    const double length = edge_direction(rods, i).length;
    // What a contact has kept from its length says nothing about tension.
    const bool is_kept =
        std::abs(length - rods.rest_lengths[i]) < learnt_from * rods.rest_lengths[i];
    found_[i] = is_kept ? force(rods, i, length) : springs_[i].tension;
  }
}

void Inextensible::end_step(Rods& /*rods*/, const TimeStep& /*step*/) {
  for (std::size_t i = 0; i < springs_.size(); ++i) {
    springs_[i].tension = found_[i];
  }
}

}  // namespace fiber
