#pragma once

#include <vector>

#include "benchmark/sim/cable_scene.hpp"

namespace fiber {

/// How a run has ended: with its process, which the simulator may take with it; by giving up, or
/// with numbers that are not finite; or as it should.
enum class CableEnding { ENDED, DIVERGED, DONE };

struct CableRun {
  CableEnding ending = CableEnding::ENDED;
  std::string reason;  ///< what the simulator says of a run that is DIVERGED
  double ms = 0.0;     ///< of the processor, for all steps

  /// At the beginning, and after each step [m]; only of a run that is DONE.
  std::vector<std::vector<Eigen::Vector3d>> positions;
};

/// Simulates a scene in a child process. No other thread may be running.
/// @throws std::runtime_error if there are no more processes or memory
CableRun run_cables(const CableScene& scene, const CableMethod& method);

}  // namespace fiber
