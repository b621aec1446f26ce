#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// What the first steps of a scene took and how far they are solved, measured on copies of it.
struct SimTrial {
  std::uint32_t steps = 0;
  double real_time_factor = 0.0;  ///< time of the scene by wall time

  /// [m] How far nodes are at most from where more Newton iterations would have them.
  double iteration_error = 0.0;

  std::string failure;  ///< why the scene does not get further than that; empty if it does
};

/// Steps two scenes made of a description, one of them with four times the iterations, for some
/// frames or some tenths of a second, whichever is less; one step at least.
/// @throws std::invalid_argument as make_sim_scene
SimTrial try_scene(SimDescription description, std::uint32_t threads);

/// What is to be expected of a scene, in sentences.
struct SimReport {
  std::vector<std::string> facts;     ///< stability, what steps damp, contacts, speed
  std::vector<std::string> warnings;  ///< what goes wrong, and what mends it
};

/// Judges steps against the waves that they resolve, grippers against the radius, contacts against
/// the stiffest that a step solves well, iterations and speed by the trial.
SimReport report(const SimScene& scene, const SimTrial& trial);

}  // namespace fiber
