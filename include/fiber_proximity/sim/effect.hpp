#pragma once

#include <cstdint>

#include "fiber_proximity/sim/rod_lanes.hpp"
#include "fiber_proximity/sim/rod_system.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// When a step begins, and how long it is [s].
struct TimeStep {
  double start;
  double length;

  double end() const { return start + length; }
};

/// One thing that acts on rods. A scene has objects only for the effects it names; what it does not
/// name takes neither time nor memory.
///
/// A step finds the minimum of the sum of all energies and of the kinetic one, the incremental
/// potential of implicit Euler. What has no potential, like drag, is brought into this form for the
/// duration of one step.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Called once before each step, by one thread. With implicit midpoint the step is the half to
  /// the middle: that is what is solved for.
  virtual void begin_step(Rods& /*rods*/, const TimeStep& /*step*/) {}

  /// Energy of a rod where it is now [J], up to a constant of the step.
  virtual double energy(const Rods& rods, std::uint32_t rod) const = 0;

  /// What of that is there again when the rod moves back [J]; what only holds it in place is not.
  virtual double stored_energy(const Rods& rods, std::uint32_t rod) const {
    return energy(rods, rod);
  }

  /// Adds the gradient of the energy by what is unknown, and a positive semidefinite matrix near
  /// its Hessian.
  virtual void add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const = 0;

  /// True if the two following functions do for rods side by side what the two above do for each;
  /// they are called with no others then.
  virtual bool works_in_lanes(const Rods& /*rods*/) const { return false; }

  /// How many numbers these need of each node that begin_step() has found, and where they are.
  virtual std::uint32_t values_per_node() const { return 0; }
  virtual const double* values_of(std::uint32_t /*node*/) const { return nullptr; }

  /// @param values those numbers, node by node
  /// @param energy by lane, overwritten
  virtual void energy_in_lanes(const RodLanes& /*rods*/, const std::vector<Lanes>& /*values*/,
                               Lanes& /*energy*/) const {}
  virtual void add_derivatives_in_lanes(const RodLanes& /*rods*/,
                                        const std::vector<Lanes>& /*values*/,
                                        LaneSystem& /*system*/) const {}

  /// Called for each rod that has been solved for, where the solution is: with implicit midpoint,
  /// in the middle of the step. A rod may be solved for again in a step: the last one counts.
  virtual void end_solve(const Rods& /*rods*/, std::uint32_t /*rod*/) {}

  /// Called once after each step, by one thread: with implicit midpoint, after the whole step.
  virtual void end_step(Rods& /*rods*/, const TimeStep& /*step*/) {}
};

}  // namespace fiber
