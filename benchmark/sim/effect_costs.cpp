#include "sim/effect_costs.hpp"

#include <malloc.h>

#include <algorithm>

#include "processor_time.hpp"

namespace fiber {

namespace {

using Names = std::vector<std::string>;

/// Memory in use on the heap [bytes]: what is asked of malloc by any way, as Eigen does not use
/// operator new.
std::size_t heap_bytes() {
#if __GLIBC_PREREQ(2, 33)
  const auto info = mallinfo2();
#else
  const auto info = mallinfo();
#endif
  return static_cast<std::size_t>(info.uordblks) + static_cast<std::size_t>(info.hblkhd);
}

EffectCost measure(const EffectScene& scene, const std::string& added, const Names& names) {
  EffectCost cost;
  cost.effects = names;
  cost.added = added;
  const std::size_t before = heap_bytes();
  EffectSimulation simulation(scene, names);
  simulation.run(std::max(1U, scene.frames / 4));
  cost.ms_per_step =
      processor_time_of([&] { simulation.run(scene.frames); }) / (scene.frames * scene.substeps);
  cost.bytes = heap_bytes() - before;
  cost.unknowns_per_node = simulation.rods().angles.empty() ? 3 : 4;
  cost.nodes = static_cast<std::uint32_t>(simulation.rods().positions.size());
  return cost;
}

}  // namespace

void measure_effects(const EffectScene& scene,
                     const std::function<void(const EffectCost&)>& report) {
  const Names base{"gravity", "stretch", "bend"};
  measure(scene, "base", base);  // what is made once in a process is no effect's
  report(measure(scene, "base", base));
  report(measure(scene, "inextensible", {"gravity", "inextensible", "bend"}));
  for (const char* added : {"twist", "damping", "drag", "plasticity", "attachment", "self_contact",
                            "fiber_contact", "environment_contact"}) {
    Names names = base;
    names.emplace_back(added);
    report(measure(scene, added, names));
  }
  Names with_friction = base;
  with_friction.insert(with_friction.end(), {"environment_contact", "friction"});
  report(measure(scene, "friction", with_friction));
  report(
      measure(scene, "all",
              {"gravity", "stretch", "bend", "twist", "damping", "drag", "plasticity", "attachment",
               "self_contact", "fiber_contact", "environment_contact", "friction"}));
}

}  // namespace fiber
