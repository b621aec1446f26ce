#pragma once

#include <optional>
#include <vector>

#include "fiber_proximity/sim/stepper.hpp"
#include "src/sim/solver/coupling.hpp"
#include "src/sim/solver/line_search.hpp"
#include "src/sim/solver/pack_step.hpp"
#include "src/sim/solver/step_bound.hpp"

namespace fiber {

/// By node or by rod, of all rods: what solvers of different rods write side by side.
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

/// Newton's method for one or more islands, rods that may touch each other in a step: finds the
/// minimum of the incremental potential near where the rods are, each step bounded and then
/// shortened until the energy falls.
class NewtonSolver {
 public:
  /// What is to be solved.
  struct Problem {
    const Effects& effects;
    const StepperOptions& options;
    double step;                                     ///< [s]
    ContactSet* contacts;                            ///< null for none
    const Room* room;                                ///< null for none: rods may go anywhere
    const Friction* friction;                        ///< null for none
    const std::vector<Eigen::Vector3d>& references;  ///< where rates are measured from, by node [m]
  };

  /// Makes it about these rods; of what it was about before, it only keeps the memory.
  /// @param packs   rods with the same number of nodes each, at most lane_count
  /// @param islands how many
  /// @param scratch with islands; must outlive this
  void assign(const Rods& rods, const std::vector<std::vector<std::uint32_t>>& packs,
              std::uint32_t islands, SolverScratch& scratch);

  /// Loads the rods where rates are measured from, and what effects have found there.
  void begin(const Rods& rods, const Effects& effects, double step);

  /// Loads where the solve starts, if that is elsewhere.
  void load(const Rods& rods);

  /// Moves the rods from there to the end of the step.
  /// @returns what more energy rods and contacts store then, all islands together [J]; none if rods
  ///          need more room: they are anywhere then
  std::optional<double> solve(Rods& rods, const Problem& problem);

  /// Of the last solve, by island.
  const std::vector<IslandReport>& reports() const { return reports_; }
  const StepBound& step_bound() const { return bound_; }

 private:
  /// An island in the course of a solve.
  struct Search {
    double decrease = 0.0;  ///< that the slope of a whole step promises [J]
    double scale = 1.0;     ///< of the next step, for the last one was so much too short
    bool is_active = true;  ///< goes on
    bool is_balanced = false;
    bool is_learning = false;  ///< was balanced before what multipliers have learnt
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

  void measure(Rods& rods, const Problem& problem);
  double stored_energy(const Problem& problem) const;
  bool predict(Rods& rods, const Problem& problem);
  void assemble(Rods& rods, const Problem& problem);
  void judge_balance(Rods& rods, const Problem& problem, std::uint32_t iteration);
  bool learn_multipliers(Rods& rods, const Problem& problem);
  void find_residuals();
  void find_step(const Problem& problem);
  void weigh_step();
  bool bound_step(const Rods& rods, const Problem& problem);
  void try_shares(Rods& rods, const Problem& problem);
  void search_line(Rods& rods, const Problem& problem, int halvings);

  std::vector<PackStep> packs_;
  std::vector<std::uint32_t> members_;  // rods
  std::vector<std::size_t> offsets_;    // of the packs in the step
  std::vector<LaneIslands> islands_;    // by pack
  SolverScratch* scratch_ = nullptr;
  std::vector<Search> searches_;       // by island
  std::vector<IslandReport> reports_;  // by island
  std::vector<EnergySum> energies_;    // by island, where its rods are
  std::vector<double> decreases_;      // by island
  std::vector<double> shares_;         // by island: the most of a step
  std::vector<SimdBatch> step_;
  LineSearch line_;
  Coupling coupling_;
  StepBound bound_;
};

}  // namespace fiber
