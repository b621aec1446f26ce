#pragma once

#include <string>
#include <vector>

#include "benchmark/sim/cable_scene.hpp"

namespace fiber {

/// Simulators of other libraries in this build, each in several settings. They may end their
/// process.
std::vector<CableMethod> peer_cables(const CableScene& scene, const std::vector<int>& segments);

/// A line for each peer that this build is without, which says what to install.
std::vector<std::string> missing_cable_peers();

// One library each, where it is in this build.
std::vector<CableMethod> bullet_ropes(const CableScene& scene, const std::vector<int>& segments);
std::vector<CableMethod> mujoco_chains(const CableScene& scene, const std::vector<int>& segments);

}  // namespace fiber
