#pragma once

#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "src/sim/solver/energy_sum.hpp"

namespace fiber {

/// Rods with the same number of nodes side by side in a step of implicit Euler: where inertia alone
/// would bring them, where they are now, and the incremental potential of that. What becomes of a
/// rod does not depend on what it is beside.
class PackStep {
 public:
  /// Makes it about these rods; what it was about before does not matter but for the memory it has.
  /// @param members from 1 to lane_count rods
  void assign(const Rods& rods, const std::vector<std::uint32_t>& members);

  const RodPack& rods() const { return pack_; }
  std::size_t used() const { return pack_.used; }
  std::uint32_t rod(std::size_t lane) const { return pack_.rods[lane]; }

  /// How many SimdBatches a step takes: what is unknown, and the zeros that solve_band() wants
  /// after it.
  std::size_t step_size() const { return system_.size() + half_bandwidth(system_.unknowns); }

  /// Begins a step: rates are measured from where the rods are.
  /// @param step [s]
  void begin(const Rods& rods, const Effects& effects, double step);

  /// Loads what effects have found of the rods, again where they have learnt.
  void load_values(const Effects& effects);

  /// Moves the rods to where they are in Rods, and back.
  void load(const Rods& rods);
  void store(Rods& rods) const;

  /// The step from where the rods are to where inertia alone would bring them.
  /// @param step step_size() of them, overwritten
  void predict(SimdBatch* step) const;

  /// Remembers where the rods are as where move() starts.
  void remember() { remembered_ = pack_.positions; }

  /// Brings each rod a share of a step away from there.
  void move(const SimdBatch* step, const SimdBatch& shares);

  /// Kinetic and potential energy of the incremental potential where the rods are now [J].
  void measure(const Effects& effects);
  const EnergySum& energy(std::size_t lane) const { return energies_[lane]; }

  /// Of that, over all rods, what is there again when they move back: without inertia [J].
  double stored_energy() const { return stored_; }

  /// Makes gradient and Hessian those of the energies where the rods are now.
  void assemble(const Effects& effects);

  /// To add what else acts on a rod to what was assembled.
  RodSystem& system(std::size_t lane) { return views_[lane]; }

  /// How far a rod's forces are from balance: the largest speed [m/s] that the force on a node
  /// would change in a step, or of a surface that the moment on an edge would turn.
  struct Residual {
    double speed;
    std::uint32_t node;  ///< from the rod's first one
  };
  Residual residual(std::size_t lane) const;
  void measure_residuals();

  /// Factorises the Hessian, and solves for minus the gradient.
  /// @param step step_size() of them, overwritten
  void find_step(SimdBatch* step);

  /// Solves for other right-hand sides.
  /// @param values step_size() of them, zeros where nothing is unknown
  void solve(SimdBatch* values) const;

  const std::vector<SimdBatch>& gradient() const { return system_.gradient; }

  /// Stores where the rods are, and the velocities that bring them there from where it began.
  void finish(Rods& rods) const;

  void add_forces(const Effects& effects, RodForces& forces) const;

 private:
  void load_constants(const Rods& rods, std::size_t lane);
  void keep_finite(SimdBatch* step) const;

  RodPack pack_;
  PackSystem system_;
  std::vector<RodSystem> views_;      // of the system, by lane
  std::vector<SimdBatch> inertias_;   // of what is unknown: masses, and those of angles
  std::vector<SimdBatch> scales_;     // from gradient to speed [s/kg], of angles times the radius
  std::vector<SimdBatch> beginning_;  // of the step
  std::vector<SimdBatch> predicted_;  // where inertia would bring the rods
  std::vector<SimdBatch> remembered_;
  std::vector<SimdBatch> residuals_;  // squared, by node
  std::array<EnergySum, lane_count> energies_;
  double stored_ = 0.0;
  std::vector<std::vector<SimdBatch>> values_;  // by effect: what it needs of the nodes
  double step_length_ = 0.0;                    // [s]
};

}  // namespace fiber
