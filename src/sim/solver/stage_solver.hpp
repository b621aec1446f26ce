#pragma once

#include <tbb/concurrent_queue.h>
#include <tbb/task_arena.h>

#include <memory>
#include <vector>

#include "fiber_proximity/sim/joints.hpp"
#include "src/geometry/disjoint_sets.hpp"
#include "src/sim/solver/newton.hpp"

namespace fiber {

/// One solve of a step: finds which rods may touch each other in it, and solves for each island by
/// itself. Rods that touch none are solved for side by side.
class StageSolver {
 public:
  /// @param contacts null for none; must outlive this
  /// @param joints   null for none; must outlive this
  StageSolver(const Rods& rods, const StepperOptions& options, Contacts* contacts, Joints* joints);

  /// @param rods      where the solve starts, free of overlaps; moved to the end
  /// @param reference where rates are measured from; null for where the solve starts
  void solve(Rods& rods, const Effects& effects, const TimeStep& stage, const RodState* reference);

  /// Keeps the slips at which friction ends the step, and which rods have had impacts, for the next
  /// one: the last solve was its last.
  void end_step(const Rods& rods);

  /// Has contacts that press when the next step begins return what they press, as after an impact:
  /// nobody has pressed them together, a rod or an obstacle was put there.
  void expect_pressed_contacts() { is_returning_.assign(is_returning_.size(), true); }

  /// Takes what another solver of the same rods has come to in its steps.
  void take_state(const StageSolver& other) {
    anchors_ = other.anchors_;
    is_returning_ = other.is_returning_;
    travel_bound_ = other.travel_bound_;
  }

  /// Forgets what sticks to an object; those behind it are counted from one less then.
  void remove_object(std::uint32_t object) { anchors_.remove_object(object); }

  /// The elastic energy of what sticks by friction [J].
  double anchor_energy() const { return anchors_.energy(); }

  /// Whether the last solve found impacts. It resolves them only if rates are measured from where
  /// it starts: extrapolated ones lead through the impact.
  bool has_impacts() const;

  /// Adds the results of the last solve.
  void add_to(StepReport& report) const;

  void add_forces(const Rods& rods, const Effects& effects, RodForces& forces);

  /// Stored energy of contacts and effects [J].
  double stored_energy(Rods& rods, const Effects& effects);

 private:
  /// Rods that are solved for together.
  struct Group {
    std::vector<std::vector<std::uint32_t>> packs;
    std::uint32_t islands = 0;
    ContactSet contacts;
    std::vector<const JointCluster*> joints;
    std::vector<JointSolver::NodeForce> joint_forces;
    std::vector<IslandReport> reports;
    double stored_gain = 0.0;  // of energy in the solve [J]
    std::vector<std::pair<std::uint32_t, double>> needed_travel;
    std::vector<std::uint32_t> stuck_objects;
    double stuck_progress = 1.0;
    std::vector<bool> has_impacts;  // by island
    bool is_solved = false;
  };

  void add_joint_forces(const Rods& rods, RodForces& forces) const;
  void add_obstacle_forces(const Rods& rods, RodForces& forces) const;
  bool shorten_obstacle_motions(std::uint32_t times);
  void reset_islands(const Rods& rods);
  void find_contacts(Rods& rods);
  void make_groups(const Rods& rods);
  void distribute_contacts();
  void predict_motion(const RodState& reference, double step);
  void widen_travel_bound(const Rods& rods);
  void adapt_travel_bound(const Rods& rods);
  void solve_group(Rods& rods, const Effects& effects, double step, Group& group);
  void copy_state(const RodState& state, const Group& group, Rods& rods, bool has_rates) const;
  template <class Function>
  void for_each_pack(const Rods& rods, const Effects& effects, const Function& function);

  StepperOptions options_;
  Contacts* contacts_;
  Joints* joints_;
  std::vector<JointCluster> joint_clusters_;
  tbb::task_arena arena_;
  DisjointSets islands_;  // of rods that may touch each other in the step, or are joined
  std::vector<std::uint32_t> island_of_;  // by rod: the smallest one of its island
  std::vector<Group> groups_;
  std::vector<std::uint32_t> grouped_;   // the islands that these groups are of, alike
  std::vector<std::uint32_t> group_of_;  // by rod
  SolverScratch scratch_;
  std::vector<ContactSet> found_by_;  // by source
  TravelBound travel_bound_;
  bool has_start_rates_ = true;  // whether rates are measured from where the solve starts
  bool is_at_start_ = true;  // whether rods are where the solve starts, and rates are measured from
  RodState start_;
  RodState reference_;
  FrictionAnchors anchors_;         // of the step before
  std::vector<bool> is_returning_;  // by rod: it had impacts in the step before, or is expected to
  FrictionOrigins origins_;         // of the solve
  double last_step_ = 0.0;          // [s]
  tbb::concurrent_queue<std::unique_ptr<NewtonSolver>> solvers_;  // that are not at work
};

}  // namespace fiber
