// The part of a solve that is about obstacles that move.

#include <algorithm>

#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "src/sim/solver/stage_solver.hpp"

namespace fiber {

using Eigen::Vector3d;

/// Where rods could not give way to obstacles, these go only as far as they came, and the solve
/// begins again: an obstacle is in one place for all rods.
/// @param times that obstacles were stuck in this solve before
/// @returns whether any is
bool StageSolver::shorten_obstacle_motions(std::uint32_t times) {
  constexpr std::uint32_t max_times = 6;  // then they stay where they are, which always may be
  constexpr double less = 0.9;
  ObstacleMotions& motions = *contacts_->motions();
  double progress = 1.0;
  std::vector<bool> which(motions.obstacles().size(), false);
  for (Group& group : groups_) {
    for (const std::uint32_t object : group.stuck_objects) {
      which[object - motions.first_index()] = true;
      progress = std::min(progress, group.stuck_progress);
    }
    group.stuck_objects.clear();
  }
  if (std::find(which.begin(), which.end(), true) == which.end()) {
    return false;
  }
  motions.shorten(which, times < max_times ? less * progress : 0.0);
  for (Group& group : groups_) {
    group.is_solved = false;
  }
  return true;
}

void StageSolver::add_obstacle_forces(const Rods& rods, RodForces& forces) const {
  const ObstacleMotions& motions = *contacts_->motions();
  std::uint32_t object = motions.first_index();
  for (const Eigen::Isometry3d& pose : motions.poses()) {
    forces.obstacles.push_back({object++, pose.translation(), Vector3d::Zero(), Vector3d::Zero()});
  }
  for (const Group& group : groups_) {
    group.contacts.add_obstacle_forces(rods, forces.obstacles);
  }
}

}  // namespace fiber
