#pragma once

#include <tbb/task_arena.h>

#include <memory>
#include <mutex>
#include <vector>

#include "src/sim/solver/islands.hpp"
#include "src/sim/solver/newton.hpp"

namespace fiber {

/// Where all rods are, and how they move.
struct RodState {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> velocities;
  std::vector<double> angles;
  std::vector<double> spins;
};

/// Copies it, into memory that is there already.
void copy_state(const Rods& rods, RodState& state);
void copy_state(const RodState& state, Rods& rods);

/// One solve of a step: finds which rods may touch each other in it, and solves for each island, or
/// some rods that touch none, on its own.
class StageSolver {
 public:
  /// @param contacts null for none; must outlive this
  StageSolver(const Rods& rods, const StepperOptions& options, Contacts* contacts);

  /// @param rods      where the solve starts, free of overlaps; moved to the end
  /// @param reference where rates are measured from; null for where the solve starts
  void solve(Rods& rods, const Effects& effects, const TimeStep& stage, const RodState* reference);

  /// Adds how the last solve has ended.
  void add_to(StepReport& report) const;

  void add_forces(const Rods& rods, const Effects& effects, RodForces& forces);

  /// Of contacts and effects [J].
  double stored_energy(Rods& rods, const Effects& effects);

 private:
  /// Rods that are solved for together.
  struct Group {
    std::vector<std::vector<std::uint32_t>> packs;
    std::uint32_t islands = 0;
    ContactSet contacts;
    std::vector<IslandReport> reports;
    double stored_gain = 0.0;  // of energy in the solve [J]
    double stiffening_energy = 0.0;
    std::vector<std::pair<std::uint32_t, double>> needed_room;
    bool is_solved = false;
  };

  void find_contacts(Rods& rods);
  void make_groups(const Rods& rods);
  void split_contacts();
  void expect(const RodState& reference, double step);
  void widen_room(const Rods& rods);
  void adapt_room(const Rods& rods);
  void stiffen_contacts();
  void adapt_stiffening(const Rods& rods);
  void solve_group(Rods& rods, const Effects& effects, double step, Group& group);
  void bring(const RodState& state, const Group& group, Rods& rods, bool has_rates) const;
  std::unique_ptr<NewtonSolver> take_solver();
  void give_back(std::unique_ptr<NewtonSolver> solver);
  template <class Function>
  void for_each_pack(const Rods& rods, const Effects& effects, const Function& function);

  StepperOptions options_;
  Contacts* contacts_;
  tbb::task_arena arena_;
  Islands islands_;
  std::vector<Group> groups_;
  std::vector<std::uint32_t> group_of_;  // by rod
  SolverScratch scratch_;
  std::vector<ContactSet> found_by_;  // by source
  ContactSet found_;
  Room room_;
  std::vector<double> stiffening_;  // of contacts that have much to hold, by rod
  std::vector<double> loads_;       // of contacts, by rod
  bool is_at_start_ = true;  // whether rods are where the solve starts, and rates are measured from
  RodState start_;
  RodState reference_;
  double last_step_ = 0.0;  // [s]
  std::mutex mutex_;        // of the solvers
  std::vector<std::unique_ptr<NewtonSolver>> solvers_;
};

}  // namespace fiber
