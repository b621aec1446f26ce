#include "benchmark/sim/effect_scene.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/joints.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Two layers, the upper one across the lower one, a little above the table and each other.
/// @param parts that each cable is made of, all with the same number of segments
Rods make_cables(const EffectScene& scene, std::uint32_t parts) {
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
    const std::size_t segments = scene.segments / parts;
    for (std::size_t part = 0; part < parts; ++part) {
      const auto first = points.begin() + static_cast<std::ptrdiff_t>(part * segments);
      rods.add({first, first + static_cast<std::ptrdiff_t>(segments) + 1}, radius, section);
    }
  }
  return rods;
}

/// An obstacle of this shape that rises.
std::vector<MovingObstacle> rising(const Shape& shape) {
  return {going(shape, Vector3d::Zero(), {0.0, 0.0, 0.05})};
}

/// A part of each cable is stiffer and heavier.
void add_sections(Rods& rods) {
  const RodSection section = solid_round_section(material_preset("power_cable"), 0.005);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    rods.set_sections(rod, {{{0.4, 0.8}, section}});
  }
}

/// Joins every second rod with the one before it, whose end is its beginning.
std::unique_ptr<Joints> join_halves(Rods& rods, Joints::Kind kind) {
  auto joints = std::make_unique<Joints>(Joints::Options{});
  for (std::uint32_t rod = 0; rod < rods.count(); rod += 2) {
    joints->add(rods, {kind, {{rod, rods.node_count(rod) - 1}, {rod + 1, 0}}});
  }
  return joints;
}

}  // namespace

EffectSimulation::EffectSimulation(const EffectScene& scene,
                                   const std::vector<std::string>& effects)
    : names_(effects), substeps_(scene.substeps) {
  const bool is_joined = has("ball") || has("weld");
  Rods rods = make_cables(scene, is_joined ? 2 : 1);
  if (has("sections")) {
    add_sections(rods);
  }
  Effects made = make_effects(rods);
  std::unique_ptr<Joints> joints;
  if (is_joined) {
    joints = join_halves(rods, has("ball") ? Joints::Kind::BALL : Joints::Kind::WELD);
  }
  StepperOptions options;
  options.threads = scene.threads;
  stepper_ = std::make_unique<Stepper>(std::move(rods), std::move(made), options, make_contacts(),
                                       std::move(joints));
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
  add("load", [&] {
    auto loads = std::make_unique<Loads>();
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      Loads::Load weight;
      weight.rod = rod;
      weight.node = rods.node_count(rod) - 1;
      weight.mass = 0.01;
      loads->add(rods, weight);
      Loads::Load force;
      force.rod = rod;
      force.part = RodPart{0.2, 0.6};
      force.force = TimeTable<Vector3d>(Vector3d(0.1, 0.1, 0.0));
      loads->add(rods, force);
    }
    return loads;
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
  std::shared_ptr<ObstacleMotions> motions;
  if (has("environment_contact")) {
    const HalfSpaceShape table{Vector3d::UnitZ(), 0.0};
    EnvironmentContact::Options options;
    options.restitution = has("restitution") ? 0.7 : options.restitution;
    if (has("motion")) {
      motions = std::make_shared<ObstacleMotions>(rising(table), 0);
      sources.push_back(std::make_unique<MovingObstacleContact>(motions, options));
    } else {
      sources.push_back(std::make_unique<EnvironmentContact>(environment_of(table), options));
    }
  }
  if (sources.empty()) {
    return nullptr;
  }
  return std::make_unique<Contacts>(
      std::move(sources),
      has("friction") ? std::make_unique<Friction>(Friction::Options{}) : nullptr, motions);
}

}  // namespace fiber
