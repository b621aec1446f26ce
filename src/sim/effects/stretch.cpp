#include "fiber_proximity/sim/effects/stretch.hpp"

#include <algorithm>

#include "fiber_proximity/sim/edge_pair.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

double Stretch::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
    const double rest = rods.rest_lengths[i];
    const double strain = (rods.positions[i + 1] - rods.positions[i]).norm() / rest - 1.0;
    energy += strain * strain * rest;
  }
  return 0.5 * rods.sections[rod].stretching_stiffness * energy;
}

void Stretch::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  const double stiffness = rods.sections[rod].stretching_stiffness;
  const std::uint32_t first = rods.first(rod);
  for (std::uint32_t i = first; i + 1 < rods.end(rod); ++i) {
    const double rest = rods.rest_lengths[i];
    const auto [length, tangent] = edge_direction(rods, i);
    const Vector3d force = stiffness * (length / rest - 1.0) * tangent;
    // Under pressure an edge gives way sideways; that part is negative definite and left out.
    const double sideways = std::max(0.0, 1.0 - rest / length);
    const Matrix3d along = tangent * tangent.transpose();
    const Matrix3d block = stiffness / rest * (along + sideways * (Matrix3d::Identity() - along));
    system.add_edge(i - first, force, block);
  }
}

}  // namespace fiber
