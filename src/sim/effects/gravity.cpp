#include "fiber_proximity/sim/effects/gravity.hpp"

#include <stdexcept>

namespace fiber {

Gravity::Gravity(const Eigen::Vector3d& acceleration) : acceleration_(acceleration) {
  if (!acceleration.allFinite()) {
    throw std::invalid_argument("gravity: the acceleration must be finite");
  }
}

double Gravity::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    energy -= rods.masses[i] * acceleration_.dot(rods.positions[i]);
  }
  return energy;
}

void Gravity::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  const std::uint32_t first = rods.first(rod);
  for (std::uint32_t i = first; i < rods.end(rod); ++i) {
    system.add_gradient(i - first, -rods.masses[i] * acceleration_);
  }
}

}  // namespace fiber
