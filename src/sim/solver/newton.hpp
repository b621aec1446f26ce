#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "fiber_proximity/sim/stepper.hpp"
#include "src/sim/solver/coupling.hpp"
#include "src/sim/solver/joint_solver.hpp"
#include "src/sim/solver/line_search.hpp"
#include "src/sim/solver/pack_step.hpp"
#include "src/sim/solver/step_bound.hpp"

namespace fiber {

/// Arrays over all rods of a simulation. Solvers of different rods write their own entries side by
/// side.
struct SolverScratch {
  void resize(const Rods& rods) {
    islands.resize(rods.count());
    systems.resize(rods.count());
    packs.resize(rods.count());
    places.resize(rods.positions.size());
    displacements.resize(rods.positions.size());
    ends.resize(rods.positions.size());
  }

  std::vector<std::uint32_t> islands;  ///< by rod: which of its solver's islands
  std::vector<RodSystem*> systems;     ///< by rod
  std::vector<std::uint32_t> packs;    ///< by rod: which of its solver's packs
  std::vector<std::size_t> places;     ///< by node, in the step
  std::vector<Eigen::Vector3d> displacements;
  std::vector<Eigen::Vector3d> ends;
};

/// Newton's method for one or more islands, which are sets of rods that may touch each other in a
/// time step: finds the minimum of the incremental potential near where the rods are. Each Newton
/// step is bounded, and then shortened by a line search.
class NewtonSolver {
 public:
  /// The system to be solved.
  struct Problem {
    const Effects& effects;
    const StepperOptions& options;
    double step;                            ///< [s]
    ContactSet* contacts;                   ///< null for none
    const TravelBound* travel_bound;        ///< null: rods may go anywhere
    const Friction* friction;               ///< null for none
    FrictionOrigins origins;                ///< where the slips of friction are measured from
    const std::vector<bool>& is_returning;  ///< by rod, see ContactSet::find_impacts()
    bool has_start_rates;  ///< measured from the start: only such a step resolves its impacts
    bool has_moving_obstacles = false;                           ///< in the scene
    const JointParts* joints = nullptr;                          ///< null for none
    const std::vector<const JointCluster*>* clusters = nullptr;  ///< of joints, of these rods
  };

  /// Replaces the rods that it solves for. Memory is reused.
  /// @param packs   rods with the same number of nodes each, at most lane_count
  /// @param islands how many
  /// @param scratch with islands; must outlive this
  void assign(const Rods& rods, const std::vector<std::vector<std::uint32_t>>& packs,
              std::uint32_t islands, SolverScratch& scratch);

  /// Loads the rods where rates are measured from, and the effects' data of their nodes.
  void begin(const Rods& rods, const Effects& effects, double step);

  /// Loads where the solve starts, if rates are measured from elsewhere.
  void load(const Rods& rods);

  /// Moves the rods from there to the end of the step.
  /// @returns the increase of stored energy of rods and contacts, over all islands [J]; none if a
  ///          rod needs a wider travel bound: positions are unspecified then
  std::optional<double> solve(Rods& rods, const Problem& problem);

  /// Reports of the last solve, by island.
  const std::vector<IslandReport>& reports() const { return reports_; }
  const StepBound& step_bound() const { return bound_; }

  /// By island: whether the last solve found impacts, or took something back after one.
  const std::vector<bool>& has_impacts() const { return has_impacts_; }

  /// After a solve that gave no result: the obstacles that have stayed behind as rods could not
  /// give way, by index, and the part of their way that they came. Empty where that was not the
  /// reason.
  const std::vector<std::uint32_t>& stuck_objects() const { return stuck_objects_; }
  double stuck_progress() const { return stuck_progress_; }

  /// The forces of joints on their nodes at the end of the last solve.
  const std::vector<JointSolver::NodeForce>& joint_forces() const { return joint_solver_.forces(); }

 private:
  /// An island in the course of a solve.
  struct IslandState {
    double predicted_decrease = 0.0;   ///< minus the directional derivative of a whole step [J]
    double scale = 1.0;                ///< factor for the next step, if the last one was too short
    std::uint32_t corrections = 0;     ///< iterations of correct_short_steps()
    double residual_before = 0.0;      ///< of the iteration before [m/s]
    bool is_free = true;               ///< nothing holds or may touch its rods
    bool is_bound = false;             ///< something holds them, or is an obstacle near them
    bool is_active = true;             ///< iterates
    bool has_friction_of_now = false;  ///< by the normal forces where its rods are
    double friction_share = 1.0;       ///< of the way to these forces that updates go
    double friction_change = 0.0;      ///< of energy by all of the way, in the last one [J]
    double gain = std::numeric_limits<double>::infinity();  ///< at the minimum before [J]
    bool has_new_gain = false;                              ///< which no iteration has answered yet
    bool is_converged = false;
    bool was_converged = false;  ///< before multipliers were updated
  };

  /// Calls function(pack, lane, island), one after the other.
  template <class Function>
  void for_each_rod(const Function& function) {
    for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
      for (std::size_t lane = 0; lane < packs_[pack].rods().used; ++lane) {
        function(pack, lane, islands_[pack][lane]);
      }
    }
  }
  SimdBatch* part(std::size_t pack) { return step_.data() + offsets_[pack]; }

  /// @param problem that has joints
  JointSolver::Problem joint_problem(const Problem& problem) const {
    return {*problem.joints, *problem.clusters, scratch_->islands,
            scratch_->packs, scratch_->places,  offsets_};
  }

  void evaluate_energies(Rods& rods, const Problem& problem);
  void sum_energies(const Problem& problem);
  void find_stored_energies(const Problem& problem, std::vector<double>& stored) const;
  void find_kinetic_energies(const Rods& rods, std::vector<double>& energies) const;
  void find_max_kinetic();
  double resolve_impacts(Rods& rods, const Problem& problem, const std::vector<Impact>& impacts);
  bool predict(Rods& rods, const Problem& problem);
  void take_obstacles_along(Rods& rods, const Problem& problem);
  bool move_obstacles(Rods& rods, const Problem& problem);
  void begin_drives(const Rods& rods, const Problem& problem);
  void raise_drives(const Rods& rods, const Problem& problem);
  void keep_stuck(const MovedShapes& moved);
  bool move_with_obstacles(Rods& rods, const Problem& problem);
  void find_obstacle_work(const Rods& rods, const Problem& problem);
  void assemble(Rods& rods, const Problem& problem);
  void add_joints_to_step(const Problem& problem);
  void find_free_islands(const Problem& problem);
  void check_convergence(Rods& rods, const Problem& problem, std::uint32_t iteration);
  bool update_multipliers(Rods& rods, const Problem& problem);
  void update_friction(const Rods& rods, const Problem& problem);
  void find_gains(const Rods& rods, const Problem& problem);
  bool take_back_gains(const Rods& rods, const Problem& problem);
  void limit_velocities(Rods& rods, const Problem& problem);
  void find_residuals();
  void find_newton_step(const Problem& problem);
  void update_directional_derivatives();
  bool bound_step(const Rods& rods, const Problem& problem);
  void evaluate_trial_step(Rods& rods, const Problem& problem);
  void line_search(Rods& rods, const Problem& problem, int halvings);
  void correct_short_steps(Rods& rods, const Problem& problem);

  std::vector<PackStep> packs_;
  std::vector<std::uint32_t> members_;  // rods
  std::vector<std::size_t> offsets_;    // of the packs in the step
  std::vector<LaneIslands> islands_;    // by pack
  SolverScratch* scratch_ = nullptr;
  std::vector<IslandState> states_;    // by island
  std::vector<IslandReport> reports_;  // by island
  std::vector<EnergySum> energies_;    // by island, where its rods are
  std::vector<double> decreases_;      // by island
  std::vector<bool> has_impacts_;      // by island
  std::vector<std::uint32_t> stuck_objects_;
  double stuck_progress_ = 1.0;
  std::vector<double> drives_;                             // of obstacles, by island [J]
  std::vector<ContactSet::MotionEnergy> motion_energies_;  // by island
  std::vector<double> obstacle_work_;                      // in the solve, by island [J]
  std::vector<double> stored_of_start_;   // energy at the start of the solve, by island [J]
  std::vector<double> kinetic_of_start_;  // energy, by island [J]
  std::vector<double> stored_;            // energy at the end of the solve, by island [J]
  std::vector<double> max_kinetic_;       // energy with which nothing is gained, by island [J]
  std::vector<double> trial_shares_;      // of the step, by island: bounds, then those accepted
  std::vector<SimdBatch> step_;

  // Buffers, so that a step allocates nothing. Those of move_obstacles() and update_friction(), by
  // island:
  std::vector<double> ways_left_;
  std::vector<double> progress_before_;
  std::vector<ContactSet::Resistance> resistances_;  // by island
  std::vector<int> rounds_waited_;                   // by island: for which obstacles have waited
  std::vector<EnergySum> energies_before_;
  std::vector<double> friction_shares_;

  // Those of find_gains() and take_back_gains(), by island:
  std::vector<double> kinetic_;
  std::vector<double> excess_;
  std::vector<double> gains_;
  std::vector<bool> is_gaining_;
  std::vector<std::uint32_t> midpoint_contacts_;

  // Those of correct_short_steps(), by island and by pack:
  std::vector<bool> is_short_;
  std::vector<bool> is_lower_;
  std::vector<IslandState> states_before_;
  std::vector<EnergySum> found_;
  std::vector<std::vector<SimdBatch>> found_positions_;
  LineSearch line_search_;
  Coupling coupling_;
  JointSolver joint_solver_;
  std::vector<SimdBatch> right_sides_;  // with joints: minus the gradient
  StepBound bound_;
};

}  // namespace fiber
