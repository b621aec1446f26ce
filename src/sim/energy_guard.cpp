#include "energy_guard.hpp"

#include <algorithm>

namespace fiber {
namespace {

/// Kinetic energy of a rod [J].
double kinetic_energy(const Rods& rods, std::uint32_t rod) {
  double energy = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    energy += 0.5 * rods.masses[i] * rods.velocities[i].squaredNorm();
    if (!rods.spins.empty()) {
      const double inertia = rods.sections[rod].inertia_per_length * rods.rest_lengths[i];
      energy += 0.5 * inertia * rods.spins[i] * rods.spins[i];
    }
  }
  return energy;
}

Merit merit_of(const Rods& rods, std::uint32_t rod, const Effects& effects) {
  Merit merit;
  merit.add(kinetic_energy(rods, rod));
  for (const std::unique_ptr<Effect>& effect : effects) {
    merit.add(effect->stored_energy(rods, rod));
  }
  return merit;
}

}  // namespace

void EnergyGuard::begin(const Rods& rods, const Effects& effects) {
  beginning_ = {rods.positions, rods.velocities, rods.angles, rods.spins};
  before_.clear();
  for (std::uint32_t rod = 0; rod < gained_.size(); ++rod) {
    before_.push_back(merit_of(rods, rod, effects));
  }
}

std::vector<std::uint32_t> EnergyGuard::bring_back_gained(Rods& rods, const Effects& effects) {
  // Energies come and go, in long steps by not a little; what has gone too far goes on growing.
  constexpr double allowed = 0.5;
  std::vector<std::uint32_t> gained;
  for (std::uint32_t rod = 0; rod < gained_.size(); ++rod) {
    const double change = merit_of(rods, rod, effects).energy - before_[rod].energy;
    if (gained_[rod] + change <= allowed * before_[rod].magnitude) {
      gained_[rod] += change;
    } else {
      gained.push_back(rod);
      bring_back(rod, rods);
    }
  }
  return gained;
}

void EnergyGuard::bring_back(std::uint32_t rod, Rods& rods) const {
  const auto restore = [&](const auto& from, auto& to) {
    if (!to.empty()) {
      std::copy(from.begin() + rods.first(rod), from.begin() + rods.end(rod),
                to.begin() + rods.first(rod));
    }
  };
  restore(beginning_.positions, rods.positions);
  restore(beginning_.velocities, rods.velocities);
  restore(beginning_.angles, rods.angles);
  restore(beginning_.spins, rods.spins);
}

void EnergyGuard::accept_again(const std::vector<std::uint32_t>& which, const Rods& rods,
                               const Effects& effects) {
  for (const std::uint32_t rod : which) {
    gained_[rod] += std::min(0.0, merit_of(rods, rod, effects).energy - before_[rod].energy);
  }
}

}  // namespace fiber
