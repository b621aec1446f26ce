#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "merit.hpp"

namespace fiber {

using Effects = std::vector<std::unique_ptr<Effect>>;
using LaneFlags = std::array<bool, lane_count>;

/// Rods with the same number of nodes side by side in a step of implicit Euler: where they began,
/// where inertia alone would bring them, where they are now, and the incremental potential of that.
/// What becomes of a rod does not depend on what it is beside.
class RodBatch {
 public:
  /// Makes it about these rods; what it was about before does not matter but for the memory it has.
  /// @param members from 1 to lane_count rods
  void assign(const Rods& rods, const std::vector<std::uint32_t>& members);

  std::size_t used() const { return lanes_.used; }
  std::uint32_t rod(std::size_t lane) const { return lanes_.rods[lane]; }

  /// How many Lanes a step takes: what is unknown, and the zeros that solve_band() wants after it.
  std::size_t step_size() const { return system_.size() + half_bandwidth(system_.unknowns); }

  /// Begins a step where the rods are, by moving them to where inertia and what holds them bring
  /// them.
  /// @param step [s]
  void begin(const Rods& rods, const Effects& effects, double step);

  /// Nodes that are held, from the rod's first one.
  const std::vector<std::uint32_t>& held(std::size_t lane) const { return held_[lane]; }

  /// Moves the rods.
  /// @param positions of all nodes of all rods [m]
  void place(const std::vector<Eigen::Vector3d>& positions);

  /// Moves the rods to where they began, but for the nodes that are held: these stay where they
  /// are.
  void stay();

  /// From there, carries those of which no node is held on with their momentum, in their shapes.
  /// @returns false if there are none
  bool drift();

  /// Remembers where the rods are as where a move() starts.
  void remember() { remembered_ = lanes_.positions; }

  /// Brings rods back there.
  void restore(const LaneFlags& which);

  /// Writes down the step that leads rods to where they began, and others nowhere.
  void way_back(const LaneFlags& which, Lanes* step) const;

  /// Brings each rod a share of a step away from there.
  /// @param step step_size() of them
  void move(const Lanes* step, const Lanes& shares);

  /// Writes down where the rods are.
  void store(Rods& rods) const;

  /// The same, but only if there are effects that do not know lanes.
  void store_for(const Effects& effects, Rods& rods) const;

  /// Measures kinetic and potential energy [J] where the rods are now, and were stored for effects.
  void measure(const Rods& rods, const Effects& effects);
  const Merit& merit(std::size_t lane) const { return merits_[lane]; }

  /// Remembers the energy of a rod.
  void accept(std::size_t lane) { accepted_[lane] = merits_[lane]; }
  const Merit& accepted(std::size_t lane) const { return accepted_[lane]; }

  /// Remembers, as the most that rods may have at the end, the kinetic energy that they began with
  /// and the potential one where they stay and were measured.
  void limit_energy() { allowed_ = energy_with(merits_, predicted_); }

  /// What rods have in excess of that where they are and were accepted [J].
  Lanes gains() const;

  /// Makes the systems those of the energies where the rods are now, and were stored.
  void assemble(const Rods& rods, const Effects& effects);

  /// To add what else acts on a rod to what was assembled.
  RodSystem& system(std::size_t lane) { return views_[lane]; }

  /// Holds what is held, factorises, and finds Newton's step.
  /// @param step step_size() of them, overwritten
  void find_step(Lanes* step);

  /// Solves for other right-hand sides.
  /// @param values step_size() of them, zeros where nothing is unknown
  void solve(Lanes* values) const { solve_band(system_, values); }

  /// Of the energies, when the step was found.
  const std::vector<Lanes>& gradient() const { return system_.gradient; }

  /// Stores, with velocities that bring the rods from where they began to where they are.
  void finish(Rods& rods) const;

 private:
  void load(const Rods& rods);
  void load_inertias(const Rods& rods, std::size_t lane);
  void load_values(const Effects& effects);
  void hold(const Rods& rods);
  Lanes energy_with(const std::array<Merit, lane_count>& merits,
                    const std::vector<Lanes>& moved_to) const;
  void keep_finite(Lanes* step) const;

  RodLanes lanes_;
  std::array<std::uint32_t, lane_count> first_nodes_{};
  LaneSystem system_;
  std::vector<RodSystem> views_;                  // of the system, by lane
  std::vector<std::vector<std::uint32_t>> held_;  // nodes, by lane
  std::vector<Lanes> inertias_;                   // of what is unknown: masses, and those of angles
  std::vector<Lanes> beginning_;                  // of the step
  std::vector<Lanes> predicted_;                  // where inertia and what holds rods bring them
  std::vector<Lanes> remembered_;
  std::array<Merit, lane_count> merits_;
  std::array<Merit, lane_count> accepted_;
  Lanes allowed_;                           // energy at the end of the step [J]
  std::vector<std::vector<Lanes>> values_;  // by effect: what it needs of the nodes
  double step_length_ = 0.0;                // [s]
};

}  // namespace fiber
