#include "sim/effect_costs.hpp"

#include <malloc.h>

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/effects/damping.hpp"
#include "fiber_proximity/sim/effects/drag.hpp"
#include "fiber_proximity/sim/effects/inextensible.hpp"
#include "fiber_proximity/sim/effects/plasticity.hpp"
#include "fiber_proximity/sim/effects/twist.hpp"
#include "processor_time.hpp"
#include "sim/contact_scenes.hpp"

namespace fiber {

using Eigen::Vector3d;

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

/// Two layers, the upper one across the lower one, a little above the table and each other.
Rods make_cables(const EffectScene& scene) {
  constexpr double radius = 0.004;
  constexpr double length = 1.0;
  constexpr double distance = 0.03;
  constexpr double wave = 0.01;
  const RodSection section = solid_round_section(material_preset("power_cable"), radius);
  Rods rods;
  for (std::uint32_t cable = 0; cable < scene.cables; ++cable) {
    const bool is_upper = cable % 2 != 0;
    const std::uint32_t row = cable / 2;
    const double place = distance * row;
    std::vector<Vector3d> points;
    for (std::uint32_t i = 0; i <= scene.segments; ++i) {
      const double along = length * i / scene.segments;
      const double across = place + wave * std::sin(6.0 * M_PI * along);
      const double height = is_upper ? 3.2 * radius : 1.1 * radius;
      points.push_back(is_upper ? Vector3d(across, along, height)
                                : Vector3d(along, across, height));
    }
    rods.add(points, radius, section);
  }
  return rods;
}

/// A simulation with the effects that are named, made as scene files have them made.
class Simulation {
 public:
  Simulation(const EffectScene& scene, const Names& names) : names_(names) {
    Rods rods = make_cables(scene);
    std::vector<std::unique_ptr<Effect>> effects = make_effects(rods);
    StepperOptions options;
    options.threads = 1;
    stepper_ =
        std::make_unique<Stepper>(std::move(rods), std::move(effects), options, make_contacts());
  }

  void run(const EffectScene& scene, std::uint32_t frames) {
    for (std::uint32_t i = 0; i < frames * scene.substeps; ++i) {
      stepper_->step(1.0 / 60.0 / scene.substeps);
    }
  }

  const Rods& rods() const { return stepper_->rods(); }

 private:
  bool has(const std::string& name) const {
    return std::find(names_.begin(), names_.end(), name) != names_.end();
  }

  std::vector<std::unique_ptr<Effect>> make_effects(Rods& rods) const {
    std::vector<std::unique_ptr<Effect>> effects;
    const auto add = [&](const char* name, const auto& make) {
      if (has(name)) {
        effects.push_back(make());
      }
    };
    add("gravity", [] { return std::make_unique<Gravity>(Vector3d(0.0, 0.0, -standard_gravity)); });
    add("stretch", [] { return std::make_unique<Stretch>(); });
    add("inextensible", [&] { return std::make_unique<Inextensible>(rods); });
    add("bend", [] { return std::make_unique<Bend>(); });
    add("twist", [&] { return std::make_unique<Twist>(rods); });
    add("damping", [] { return std::make_unique<Damping>(0.01); });
    add("drag", [] {
      Drag::Options wind;
      wind.wind.mean = {5.0, 1.0, 0.0};
      wind.wind.gust = {2.0, 0.0, 1.0};
      return std::make_unique<Drag>(wind);
    });
    add("plasticity", [&] { return std::make_unique<Plasticity>(rods, Plasticity::Options{}); });
    add("attachment", [&] {
      std::vector<Attachment::Hold> holds;
      for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
        holds.push_back(pin(0, rods.positions[rods.first(rod)]));
        holds.back().rod = rod;
      }
      return hold(rods, holds);
    });
    return effects;
  }

  std::unique_ptr<Contacts> make_contacts() const {
    std::vector<std::unique_ptr<ContactSource>> sources;
    const auto add_fibers = [&](const char* name, Pairing pairing) {
      if (has(name)) {
        sources.push_back(std::make_unique<FiberContact>(FiberContact::Options{pairing, 0.0}));
      }
    };
    add_fibers("self_contact", Pairing::SAME_FIBER);
    add_fibers("fiber_contact", Pairing::DIFFERENT_FIBERS);
    if (has("environment_contact")) {
      const auto table = environment_of(HalfSpaceShape{Vector3d::UnitZ(), 0.0});
      sources.push_back(std::make_unique<EnvironmentContact>(table, EnvironmentContact::Options{}));
    }
    if (sources.empty()) {
      return nullptr;
    }
    return std::make_unique<Contacts>(
        std::move(sources),
        has("friction") ? std::make_unique<Friction>(Friction::Options{}) : nullptr);
  }

  Names names_;
  std::unique_ptr<Stepper> stepper_;
};

EffectCost measure(const EffectScene& scene, const std::string& added, const Names& names) {
  EffectCost cost;
  cost.effects = names;
  cost.added = added;
  const std::size_t before = heap_bytes();
  Simulation simulation(scene, names);
  simulation.run(scene, std::max(1U, scene.frames / 4));
  cost.ms_per_step = processor_time_of([&] { simulation.run(scene, scene.frames); }) /
                     (scene.frames * scene.substeps);
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
