#pragma once

#include "benchmark/sim/cable_scene.hpp"
#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// Our own simulation.
/// @param substeps of CableScene::step
std::unique_ptr<CableSimulation> make_own_cables(const CableScene& scene, int segments,
                                                 const StepperOptions& options, int substeps = 1);

/// With several residuals, by the integrators that suit the scene. The first one of each number of
/// segments has the default options.
std::vector<CableMethod> own_cables(const CableScene& scene, const std::vector<int>& segments);

}  // namespace fiber
