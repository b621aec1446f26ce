#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmark/sim/effect_scene.hpp"

namespace fiber {

/// The time and memory of simulating the scene with these effects, on one thread.
struct EffectCost {
  std::vector<std::string> effects;  ///< their names in scene files
  std::string added;                 ///< beside the base, or "base" or "all"
  double ms_per_step = 0.0;
  std::size_t bytes = 0;  ///< on the heap, rods included
  int unknowns_per_node = 3;
  std::uint32_t nodes = 0;
};

/// With gravity, stretch and bend, and with each effect added to these alone; with all of them.
/// Inextensible takes the place of stretch; restitution, motion and friction come with
/// environment_contact; what rolls has friction and twist.
void measure_effects(const EffectScene& scene,
                     const std::function<void(const EffectCost&)>& report);

}  // namespace fiber
