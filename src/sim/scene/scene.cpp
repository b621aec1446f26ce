#include "fiber_proximity/sim/scene/scene.hpp"

#include <utility>

#include "src/sim/scene/effects.hpp"
#include "src/sim/scene/overlap.hpp"

namespace fiber {

void SimScene::advance() {
  for (std::uint32_t i = 0; i < substeps; ++i) {
    stepper->step(step_length());
  }
}

double SimScene::residual_force() const {
  const IslandReport& worst = stepper->report().worst;
  const Rods& rods = stepper->rods();
  return worst.residual * rods.masses[rods.first(worst.rod) + worst.node] / step_length();
}

SimScene make_sim_scene(const SimDescription& description, std::uint32_t threads) {
  SimScene scene;
  static_cast<SimSettings&>(scene) = static_cast<const SimSettings&>(description);
  scene.options.threads = threads;
  Rods rods = description.rods;
  MadeEffects effects = make_effects(description, rods, scene);
  scene.overlap_note = settle_overlaps(description, scene.attachment, rods);
  scene.stepper = std::make_unique<Stepper>(std::move(rods), std::move(effects.effects),
                                            scene.options, std::move(effects.contacts));
  return scene;
}

}  // namespace fiber
