#include "benchmark/sim/effect_costs.hpp"

#include <malloc.h>

#include <algorithm>

#include "benchmark/processor_time.hpp"

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

/// All but the time.
EffectCost weigh(const EffectScene& scene, const std::string& added, const Names& names) {
  EffectCost cost;
  cost.effects = names;
  cost.added = added;
  const std::size_t before = heap_bytes();
  EffectSimulation simulation(scene, names);
  simulation.run(std::max(1U, scene.frames / 4));
  cost.bytes = heap_bytes() - before;
  cost.unknowns_per_node = simulation.rods().angles.empty() ? 3 : 4;
  cost.nodes = static_cast<std::uint32_t>(simulation.rods().positions.size());
  return cost;
}

/// In turns, some frames of each: where a machine is slower for a while, it is for all.
void measure_times(const EffectScene& scene, std::vector<EffectCost>& costs) {
  constexpr std::uint32_t together = 10;  // frames
  std::vector<EffectSimulation> simulations;
  for (const EffectCost& cost : costs) {
    simulations.emplace_back(scene, cost.effects);
    simulations.back().run(std::max(1U, scene.frames / 4));
  }
  for (std::uint32_t done = 0; done < scene.frames; done += together) {
    const std::uint32_t frames = std::min(together, scene.frames - done);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      costs[i].ms_per_step +=
          processor_time_of([&] { simulations[i].run(frames); }) / (scene.frames * scene.substeps);
    }
  }
}

}  // namespace

void measure_effects(const EffectScene& scene,
                     const std::function<void(const EffectCost&)>& report) {
  const Names base{"gravity", "stretch", "bend"};
  weigh(scene, "base", base);  // what is made once in a process is no effect's
  std::vector<EffectCost> costs;
  const auto add = [&](const std::string& added, const Names& names) {
    costs.push_back(weigh(scene, added, names));
  };
  add("base", base);
  add("inextensible", {"gravity", "inextensible", "bend"});
  for (const char* added :
       {"twist", "damping", "drag", "plasticity", "attachment", "load", "sections", "ball", "weld",
        "self_contact", "fiber_contact", "environment_contact"}) {
    Names names = base;
    names.emplace_back(added);
    add(added, names);
  }
  Names on_table = base;
  on_table.emplace_back("environment_contact");
  for (const char* added : {"restitution", "motion", "friction"}) {
    Names names = on_table;
    names.emplace_back(added);
    add(added, names);
  }
  Names rolling = on_table;
  rolling.insert(rolling.end(), {"friction", "twist"});
  add("rolling", rolling);
  add("all", {"gravity", "stretch", "bend", "twist", "damping", "drag", "plasticity", "attachment",
              "self_contact", "fiber_contact", "environment_contact", "friction"});
  measure_times(scene, costs);
  std::for_each(costs.begin(), costs.end(), report);
}

}  // namespace fiber
