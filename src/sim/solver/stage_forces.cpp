// Forces and stored energy at the end of a solve.

#include "src/sim/solver/stage_solver.hpp"

namespace fiber {

/// Calls function(pack) for the packs of all groups, one after the other, where the rods are now.
template <class Function>
void StageSolver::for_each_pack(const Rods& rods, const Effects& effects,
                                const Function& function) {
  PackStep step;
  for (const Group& group : groups_) {
    for (const std::vector<std::uint32_t>& pack : group.packs) {
      step.assign(rods, pack);
      step.begin(rods, effects, last_step_);
      function(step);
    }
  }
}

void StageSolver::add_forces(const Rods& rods, const Effects& effects, RodForces& forces) {
  for_each_pack(rods, effects, [&](const PackStep& pack) { pack.add_forces(effects, forces); });
  for (const Group& group : groups_) {
    group.contacts.add_forces(rods, forces.contacts);
  }
  if (joints_ != nullptr) {
    add_joint_forces(rods, forces);
  }
  if (contacts_ != nullptr && contacts_->motions() != nullptr) {
    add_obstacle_forces(rods, forces);
  }
}

double StageSolver::stored_energy(Rods& rods, const Effects& effects) {
  double energy = 0.0;
  for_each_pack(rods, effects, [&](PackStep& pack) {
    pack.evaluate_energies(effects);
    for (std::size_t lane = 0; lane < pack.rods().used; ++lane) {
      energy += pack.stored_energy(lane);
    }
  });
  for (Group& group : groups_) {
    group.contacts.update_distances(rods);
    group.contacts.evaluate_energies(rods);
    energy += group.contacts.stored_energy();
  }
  if (joints_ != nullptr) {
    energy += joints_->stored_energy(rods);
  }
  return energy;
}

}  // namespace fiber
