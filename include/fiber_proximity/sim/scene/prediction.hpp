#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// How a held node is to move from now on; it stays where the last entry of the path has it.
struct HoldTrajectory {
  std::uint32_t rod = 0;
  std::uint32_t node = 0;  ///< from the rod's first one; it is held from now on if it is not yet
  PlacementPath path;      ///< times from now [s]; from where the node is held on straight lines
};

/// How an obstacle that follows a frame of tf is to move from now on; it stays where the last entry
/// of the path has it.
struct ObstacleTrajectory {
  std::uint32_t obstacle = 0;  ///< index among those that move
  ObstaclePath path;           ///< times from now [s]; from where the obstacle is
};

/// The options of a prediction.
struct PredictionOptions {
  static constexpr double max_duration = 3600.0;

  double duration = 1.0;       ///< [s] to look ahead, whole frames, at most max_duration
  double sample_period = 0.0;  ///< [s] from one sample of the fibres to the next; 0: the end alone
  double margin = 0.1;         ///< [m] least distances up to this are told; finite, at least 0
};

/// The least distance of a pair of bodies in the time that was looked at.
struct PredictedClearance {
  bool is_object = false;  ///< whether contact.fiber_b is an object of the environment
  Contact contact;         ///< at this time; fiber_b of a fibre and itself is fiber_a
  double time = 0.0;       ///< [s] from now
};

/// Two bodies that press on each other in some frame.
struct PredictedTouch {
  std::uint32_t rod = 0;
  bool is_object = false;
  std::uint32_t other = 0;  ///< rod or object
  double first = 0.0;       ///< [s] from now: of the first frame and the last
  double last = 0.0;
  double max_force = 0.0;  ///< [N] of all contacts between them together, sum of sizes
  double time_of_max = 0.0;
};

/// The greatest of a force in the time that was looked at.
struct GreatestForce {
  std::uint32_t rod = 0;
  std::uint32_t node = 0;  ///< of a hold or joint; of a tension the first one of its edge
  double force = 0.0;      ///< [N]
  double time = 0.0;       ///< [s] from now
};

/// A problem of a frame: a fibre that is stretched too far, what is held or moves and lags behind,
/// or forces that do not balance.
struct PredictedWarning {
  std::string text;
  double time = 0.0;  ///< [s] from now: of the first frame with a problem of the kind
};

/// Where fibres will be, and what happens on the way.
struct Prediction {
  /// Where the nodes are at a time.
  struct Sample {
    double time;                             ///< [s] from now
    std::vector<Eigen::Vector3d> positions;  ///< [m]
  };
  std::vector<Sample> samples;
  std::vector<PredictedClearance> clearances;  ///< by bodies, those of fibres first
  std::vector<PredictedTouch> touches;         ///< by bodies, those of fibres first
  std::vector<GreatestForce> tensions;         ///< by rod
  std::vector<GreatestForce> holds;            ///< by hold
  std::vector<GreatestForce> joints;           ///< by node that is joined
  std::vector<PredictedWarning> warnings;      ///< the first of each kind
  double time = 0.0;                           ///< [s] how far it came
  std::uint32_t unbalanced_frames = 0;         ///< in which a step ended before forces balanced

  /// Why it came no further than `time`, as where the motion diverges; empty if it came to the end.
  std::string problem;
};

/// Where the hold of a node of a rod has it now, counted from the rod's first one; or where the
/// node is if nothing holds it, with directions along x and y.
/// @throws std::invalid_argument without the effect attachment, and for a node that is not there
Placement placement_now(const SimScene& scene, std::uint32_t rod, std::uint32_t node);

/// Has holds of a scene follow trajectories from now on.
/// @throws std::invalid_argument naming trajectory, entry and value, and what is allowed: for a
///         scene without the effect attachment, a rod or node that there is not, a node that is in
///         two trajectories, no entries, times that do not rise from 0, a place or direction that
///         is not finite, a way that begins elsewhere than the hold is, or goes faster than 1000
///         m/s; the scene is unchanged then
void follow(SimScene& scene, const std::vector<HoldTrajectory>& trajectories);

/// Has obstacles of a scene follow trajectories from now on.
/// @throws std::invalid_argument likewise
void follow(SimScene& scene, const std::vector<ObstacleTrajectory>& trajectories);

/// Moves a scene on, as a copy_sim_scene() of a running one, and tells what happens. Distances and
/// forces are those at the ends of frames.
/// @param is_cancelled asked after each frame
/// @throws std::invalid_argument for options that are not allowed
Prediction predict(
    SimScene& scene, const PredictionOptions& options,
    const std::function<bool()>& is_cancelled = [] { return false; });

}  // namespace fiber
