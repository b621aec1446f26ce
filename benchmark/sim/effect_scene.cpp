#include "benchmark/sim/effect_scene.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

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

}  // namespace

EffectSimulation::EffectSimulation(const EffectScene& scene,
                                   const std::vector<std::string>& effects)
    : names_(effects), substeps_(scene.substeps) {
  Rods rods = make_cables(scene);
  Effects made = make_effects(rods);
  StepperOptions options;
  options.threads = scene.threads;
  stepper_ = std::make_unique<Stepper>(std::move(rods), std::move(made), options, make_contacts());
}

void EffectSimulation::run(std::uint32_t frames) {
  for (std::uint32_t i = 0; i < frames * substeps_; ++i) {
    stepper_->step(1.0 / 60.0 / substeps_);
  }
}

bool EffectSimulation::has(const std::string& name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

Effects EffectSimulation::make_effects(Rods& rods) const {
  Effects effects;
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

std::unique_ptr<Contacts> EffectSimulation::make_contacts() const {
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

}  // namespace fiber
