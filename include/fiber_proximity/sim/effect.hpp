#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/sim/pack_system.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

struct RodForces;

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
/// duration of one step. Energies are those of rods side by side, a rod in each lane of a pack.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Called once before each solve, by one thread, with the rods where rates of the step are
  /// measured from: where it began, or for the second stage of a scheme of two where the first one
  /// points to.
  virtual void begin_step(Rods& /*rods*/, const TimeStep& /*step*/) {}

  /// How many numbers the energy needs of each node that begin_step() has found, and where they
  /// are.
  virtual std::uint32_t values_per_node() const { return 0; }
  virtual const double* values_of(std::uint32_t /*node*/) const { return nullptr; }

  /// Energy of the rods where they are now [J], up to a constant of the step; of the values the
  /// effect has those numbers, node by node.
  /// @param energy by lane, overwritten
  virtual void energy(const RodPack& /*rods*/, const std::vector<SimdBatch>& /*values*/,
                      SimdBatch& energy) const {
    energy = SimdBatch{};
  }

  /// Adds the gradient of the energy by what is unknown, and a positive semidefinite matrix near
  /// its Hessian.
  virtual void add_derivatives(const RodPack& /*rods*/, const std::vector<SimdBatch>& /*values*/,
                               PackSystem& /*system*/) const {}

  /// Whether the energy is there again when the rods move back; if not, it only resists motion.
  virtual bool is_stored() const { return true; }

  /// Whether the effect holds a condition by forces that it has to learn.
  virtual bool has_multipliers() const { return false; }

  /// Called where a rod's energy is at a minimum. What holds a condition by a force that it has to
  /// learn (a Lagrange multiplier) learns it here.
  /// @returns whether the condition holds as well as it should; the minimum is looked for again
  ///          until it does
  virtual bool update_multipliers(const Rods& /*rods*/, std::uint32_t /*rod*/) { return true; }

  /// Called once after each step, by one thread.
  virtual void end_step(Rods& /*rods*/, const TimeStep& /*step*/) {}

  /// Adds what acts inside of the rods and on them where they are now.
  virtual void add_forces(const RodPack& /*rods*/, const std::vector<SimdBatch>& /*values*/,
                          RodForces& /*forces*/) const {}
};

using Effects = std::vector<std::unique_ptr<Effect>>;

}  // namespace fiber
