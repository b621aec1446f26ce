#pragma once

#include "benchmark/sim/cable_run.hpp"

namespace fiber {

/// How cables of any simulator moved, judged by the positions of nodes, joined by straight edges.
struct CableVerdict {
  double moved = 0.0;  ///< farthest of a node from where it began [m]
  double speed = 0.0;  ///< of the fastest node in the last step [m/s]

  // These are for cables that touch: how deep surfaces are in each other or in the floor, in radii.
  double depth = 0.0;    ///< deepest in the last quarter of a second
  double deepest = 0.0;  ///< of all states
  int passed = 0;        ///< pairs of cables whose axes met, and cables that end below the floor
};

/// @param run one that is DONE
CableVerdict judge_cables(const CableScene& scene, const CableRun& run);

}  // namespace fiber
