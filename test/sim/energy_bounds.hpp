#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fiber_proximity/sim/stepper.hpp"
#include "sim/random_rods.hpp"

namespace fiber::test {

inline const Eigen::Vector3d gravity(0.0, 0.0, -9.81);

using Storing = std::vector<const Effect*>;  // those that give back what they take

/// That of a rod's motion, and of all that gives it back: not of what only damps [J].
inline double mechanical_energy(const Rods& rods, std::uint32_t rod, const Storing& storing) {
  double energy = kinetic_energy(rods, rod);
  for (const Effect* effect : storing) {
    energy += effect->energy(rods, rod);
  }
  return energy;
}

/// The same without signs.
inline double magnitude(const Rods& rods, std::uint32_t rod, const Storing& storing) {
  double energy = kinetic_energy(rods, rod);
  for (const Effect* effect : storing) {
    energy += std::abs(effect->energy(rods, rod));
  }
  return energy;
}

/// How far the potential of gravity can fall by what lets a rod [J].
inline double reach_of_gravity(const Rods& rods, std::uint32_t rod) {
  double length = 0.0;
  double mass = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    length += rods.rest_lengths[i];
    mass += rods.masses[i];
  }
  return 2.0 * mass * gravity.norm() * length;
}

/// What each rod may have of energy: no more than it began with; with implicit midpoint, which lets
/// energies come and go, half as much more as there ever was of it in the rod.
class EnergyBounds {
 public:
  EnergyBounds(const Rods& rods, const Storing& storing, Integrator integrator)
      : storing_(storing), share_(integrator == Integrator::IMPLICIT_MIDPOINT ? 0.5 : 0.0) {
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      const double energy = mechanical_energy(rods, rod, storing);
      rods_.push_back({energy, 1e-6 * (std::abs(energy) + reach_of_gravity(rods, rod)),
                       magnitude(rods, rod, storing)});
    }
  }

  /// To be asked after each step.
  testing::AssertionResult hold(const Rods& rods) {
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      Bound& bound = rods_[rod];
      const double energy = mechanical_energy(rods, rod, storing_);
      if (!(energy <= bound.begun_with + bound.rounding + share_ * bound.magnitude)) {
        return testing::AssertionFailure()
               << "rod " << rod << ", from " << bound.begun_with << " J to " << energy << " J";
      }
      bound.magnitude = std::max(bound.magnitude, magnitude(rods, rod, storing_));
    }
    return testing::AssertionSuccess();
  }

 private:
  struct Bound {
    double begun_with;
    double rounding;
    double magnitude;  // the most so far
  };

  Storing storing_;
  double share_;
  std::vector<Bound> rods_;
};

}  // namespace fiber::test
