#pragma once

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <vector>

#include "coupled_step.hpp"
#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/stepper.hpp"
#include "rod_batch.hpp"

namespace fiber {

/// Energy that a step of implicit Euler gains: implicit midpoint wants its half as it is.
enum class Gains { LEFT, TAKEN };

/// Rods whose equations are solved together: all of them where there are contacts, one batch where
/// there are none.
class RodGroup {
 public:
  /// One without rods.
  /// @param contacts null for none; must outlive this
  explicit RodGroup(Contacts* contacts);

  /// Makes it about these rods; of what it was about before, it only keeps the memory.
  /// @param batches rods with the same number of nodes each, at most lane_count; without contacts,
  ///                one batch
  void assign(const Rods& rods, const Batches& batches);

  /// Moves the rods by one step of implicit Euler.
  /// @param step [s]
  void solve(Rods& rods, const Effects& effects, const StepperOptions& options, double step,
             Gains gains);

 private:
  enum class Work { LITTLE, MUCH };

  /// The search of rods for a minimum: each has its own, but where contacts may join them, in
  /// islands, there is one for all of these.
  struct Search {
    Merit accepted;             ///< of the rods, without contacts
    Merit tried;                ///< of the rods and what they touch
    Merit contacts;             ///< of what they touch, when the line search began
    double gained = 0.0;        ///< beyond what the rods may end with [J]
    double decrease = 0.0;      ///< that the slope promises for a whole step [J]
    double longest = 0.0;       ///< component of the step
    double share = 1.0;         ///< of the step, to be tried
    bool is_active = true;      ///< goes on
    bool is_searching = false;  ///< has not found a share of this step
    bool is_accepting = false;  ///< where its rods were measured
    bool is_beyond = false;     ///< has gained more than its rods can lose by being slower
  };

  /// Of a search's rods, but for what is held.
  struct Motion {
    std::vector<std::uint32_t> nodes;
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< that all have [m/s]
    double common = 0.0;                                 ///< kinetic energy of that [J]
    double relative = 0.0;                               ///< and of the rest
  };

  void prepare_coupling(const Rods& rods);
  template <typename Function>
  void for_each_batch(Work work, const Function& function);
  template <typename Function>
  void for_each_rod(const Function& function);
  Search& search_of(std::size_t batch, std::size_t lane);
  Lanes* part(std::vector<Lanes>& values, std::size_t batch);

  void limit_start(Rods& rods, const Effects& effects);
  void limit_again(Rods& rods, const Effects& effects);
  bool is_limited(const Rods& rods, std::uint32_t rod) const;
  void stop_torn(Rods& rods, const Effects& effects, std::size_t batch);
  bool restart_lost(Rods& rods, const Effects& effects, Gains gains);
  void limit_energy(Rods& rods, const Effects& effects);
  void take_gains(Rods& rods, const Effects& effects);
  void weigh_gains(const Rods& rods);
  bool is_any_beyond() const;
  Motion motion_of(const Rods& rods, const Search& search);
  void aim_back(Rods& rods);
  void go_back(Rods& rods, const Effects& effects, double share);
  void slow_down(Rods& rods, const Search& search);
  void begin_searches();
  void join_searches();
  void join_touching();
  void iterate(Rods& rods, const Effects& effects, const StepperOptions& options);
  void measure(Rods& rods, const Effects& effects);
  void measure_contacts(const Rods& rods);
  void accept();
  void find_step(Rods& rods, const Effects& effects);
  void stop_inactive();
  void weigh_step();
  void correct_step();
  void take_displacements();
  void limit_step(const Rods& rods);
  void search_line(Rods& rods, const Effects& effects);
  bool judge_step();
  void move();

  std::vector<RodBatch> batches_;
  Contacts* contacts_;
  std::vector<RodSystem*> systems_;   // by rod
  std::vector<std::size_t> offsets_;  // of the batches in steps
  std::vector<std::size_t> places_;   // of the nodes' positions in these
  std::vector<LaneFlags> is_found_;   // by batch: not lost
  std::vector<Search> searches_;      // by island where there are contacts, else by lane
  std::vector<Lanes> step_;
  std::vector<LaneIndices> islands_;  // by batch: of searches, to which its rods belong
  std::vector<double> decreases_;     // by search
  CoupledStep coupled_step_;
  std::vector<double> contact_energies_;        // [J] by rod
  std::vector<double> allowed_contacts_;        // [J] by rod: what contacts may end with
  std::vector<bool> is_accepting_;              // by rod: its search is
  std::vector<Eigen::Vector3d> beginning_;      // of the step, where there are contacts
  std::vector<Eigen::Vector3d> displacements_;  // of nodes, to be limited
  std::vector<Eigen::Vector3d> ends_;           // of ways from the beginning
  std::vector<Eigen::Vector3d> wanted_;         // before they were
};

/// In parallel, but little work only if there are many: one of them is done before another thread
/// has heard of it.
template <typename Function>
void RodGroup::for_each_batch(Work work, const Function& function) {
  const std::size_t together = work == Work::MUCH ? 1 : 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batches_.size(), together),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t batch = range.begin(); batch < range.end(); ++batch) {
                        function(batch);
                      }
                    });
}

/// One after the other.
template <typename Function>
void RodGroup::for_each_rod(const Function& function) {
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    for (std::size_t lane = 0; lane < batches_[batch].used(); ++lane) {
      function(batch, lane);
    }
  }
}

}  // namespace fiber
