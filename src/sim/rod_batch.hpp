#pragma once

#include <vector>

#include "fiber_proximity/sim/rod_lanes.hpp"
#include "fiber_proximity/sim/stepper.hpp"
#include "moving_rod.hpp"

namespace fiber {

/// Rods with the same number of nodes, without twist and contacts, that are moved side by side.
/// Each moves as RodGroup would move it alone, whatever the others do.
class RodBatch {
 public:
  /// @param members from 1 to lane_count rods
  RodBatch(const Rods& rods, const std::vector<std::uint32_t>& members);

  /// Moves the rods by one step of implicit Euler.
  /// @param step [s]
  void solve(Rods& rods, const Effects& effects, const StepperOptions& options, double step);

 private:
  using Flags = std::array<bool, lane_count>;

  void load(const Rods& rods);
  void load_values(const Rods& rods, const Effects& effects);
  void hold(const Rods& rods);
  void carry();
  void measure(Rods& rods, const Effects& effects);
  void iterate(Rods& rods, const Effects& effects, const StepperOptions& options, Flags active);
  void find_step(const Rods& rods, const Effects& effects);
  Flags search(Rods& rods, const Effects& effects, const Flags& active);
  void move(const Lanes& shares);
  void store_positions(Rods& rods) const;
  void finish(Rods& rods) const;

  RodLanes lanes_;
  LaneSystem system_;
  std::vector<RodSystem> views_;                   // of the system, by lane
  std::vector<std::vector<std::uint32_t>> held_;   // nodes, by lane
  std::vector<Lanes> beginning_;                   // positions
  std::vector<Lanes> predicted_;                   // where inertia and what holds rods bring them
  std::vector<Lanes> iterate_;                     // where a move() starts
  std::vector<Lanes> step_;                        // and zeros after it
  std::array<Merit, lane_count> merits_;           // where they were tried last
  std::array<Merit, lane_count> accepted_merits_;  // and where they were accepted
  std::vector<std::vector<Lanes>> values_;         // by effect: what it needs of the nodes
  double step_length_ = 0.0;                       // [s]
};

}  // namespace fiber
