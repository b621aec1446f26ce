#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "fiber_proximity/sim/stepper.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"

namespace fiber::test {

inline const Eigen::Vector3d gravity(0.0, 0.0, -9.81);

using Storing = std::vector<const Effect*>;  // those that give back what they take

inline Storing storing_of(const Effects& effects) {
  Storing storing;
  for (const auto& effect : effects) {
    if (effect->is_stored()) {
      storing.push_back(effect.get());
    }
  }
  return storing;
}

/// So that energies are those of steps like this.
inline void begin(const Effects& effects, Rods& rods, double step) {
  for (const auto& effect : effects) {
    effect->begin_step(rods, {0.0, step});
  }
}

/// A rod's weight times its length [J].
inline double weight_times_length(const Rods& rods, std::uint32_t rod) {
  double length = 0.0;
  double mass = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    length += rods.rest_lengths[i];
    mass += rods.masses[i];
  }
  return mass * gravity.norm() * length;
}

/// The energy that each rod may have after a step, at most.
///
/// With implicit Euler: not to move at all would leave the incremental potential that there was of
/// kinetic and potential energy, and no step ends higher, however few its iterations are. So what
/// the rod stores, and half the square of how its speeds change, are no more than that. With BDF2,
/// which overshoots where rods begin far from equilibrium: half as much more as there was in its
/// first steps, after however many.
class EnergyBounds {
 public:
  EnergyBounds(const Rods& rods, Storing storing, Integrator integrator)
      : storing_(std::move(storing)), integrator_(integrator), before_(rods) {
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      const Energies now = energies_of(rods, rod);
      rods_.push_back({now.total(), now.total(), now.magnitude + weight_times_length(rods, rod)});
    }
  }

  /// Checks the bounds after each step.
  testing::AssertionResult hold(const Rods& rods) {
    ++steps_;
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      const testing::AssertionResult is_held =
          integrator_ == Integrator::IMPLICIT_EULER ? hold_euler(rods, rod) : hold_bdf2(rods, rod);
      if (!is_held) {
        return is_held;
      }
    }
    before_ = rods;
    return testing::AssertionSuccess();
  }

 private:
  struct Bound {
    double last;     // energy
    double largest;  // that there was in the first steps
    double scale;    // of energies
  };

  struct Energies {
    double kinetic = 0.0;
    double potential = 0.0;
    double magnitude = 0.0;  // of all parts without their signs

    double total() const { return kinetic + potential; }
  };

  testing::AssertionResult hold_euler(const Rods& rods, std::uint32_t rod) {
    constexpr double rounding = 1e-9;
    const Energies now = energies_of(rods, rod);
    const double found = now.potential + change_of(rods, rod);
    const double allowed = rods_[rod].last + rounding * rods_[rod].scale;
    rods_[rod].last = now.total();
    return judged(rod, found, allowed);
  }

  testing::AssertionResult hold_bdf2(const Rods& rods, std::uint32_t rod) {
    constexpr double more = 0.5;
    constexpr int first_steps = 20;
    const double found = energies_of(rods, rod).total();
    Bound& bound = rods_[rod];
    if (steps_ <= first_steps) {
      bound.largest = std::max(bound.largest, found);
      bound.scale = std::max(bound.scale, std::abs(found));
    }
    return judged(rod, found, bound.largest + more * bound.scale);
  }

  static testing::AssertionResult judged(std::uint32_t rod, double found, double allowed) {
    if (found <= allowed) {
      return testing::AssertionSuccess();
    }
    return testing::AssertionFailure()
           << "rod " << rod << ": " << found << " J, allowed are " << allowed << " J";
  }

  Energies energies_of(const Rods& rods, std::uint32_t rod) {
    pack_.assign(rods, {rod});
    pack_.begin(rods, {}, 1.0);
    Energies energies;
    energies.kinetic = energies.magnitude = kinetic_energy(rods, rod);
    for (const Effect* effect : storing_) {
      const double energy = energy_in(*effect, pack_.rods());
      energies.potential += energy;
      energies.magnitude += std::abs(energy);
    }
    return energies;
  }

  /// The kinetic energy of how much faster the rod has become.
  double change_of(Rods rods, std::uint32_t rod) const {
    for (std::size_t i = 0; i < rods.velocities.size(); ++i) {
      rods.velocities[i] -= before_.velocities[i];
    }
    for (std::size_t i = 0; i < rods.spins.size(); ++i) {
      rods.spins[i] -= before_.spins[i];
    }
    return kinetic_energy(rods, rod);
  }

  Storing storing_;
  Integrator integrator_;
  Rods before_;
  int steps_ = 0;
  std::vector<Bound> rods_;
  PackStep pack_;  // with room for one rod
};

}  // namespace fiber::test
