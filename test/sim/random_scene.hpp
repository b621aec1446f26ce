// Rods and effects drawn at random, for tests and campaigns.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/energy_bounds.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {

/// Rods and effects of which each is there by chance, and what it takes to judge them.
struct RandomScene {
  Rods rods;
  Effects effects;
  std::unique_ptr<Contacts> contacts;
  StepperOptions options;
  double step = 0.0;
  bool is_windy = false;
  bool has_friction = false;
  bool has_table = false;
  bool is_inextensible = false;
  std::string description;
};

/// Chains in cells of their own, so that none begins in another, thrown at each other.
inline Rods random_rods_apart(Random& random, double cell,
                              const std::optional<RodMaterial>& preset = std::nullopt) {
  Rods rods;
  const RodMaterial drawn{std::pow(10.0, random.uniform(5.0, 9.0)),
                          std::pow(10.0, random.uniform(5.0, 9.0)), random.uniform(500.0, 5000.0)};
  const RodMaterial material = preset.value_or(drawn);
  const double radius = cell * random.uniform(0.01, 0.04);
  const RodSection section = solid_round_section(material, radius);
  const int count = random.integer(2, 5);
  const double speed = std::pow(10.0, random.uniform(-1.0, 1.0));
  for (int rod = 0; rod < count; ++rod) {
    const int edges = random.integer(1, 14);
    const int layer = rod / 4;
    const Eigen::Vector3d middle(cell * (rod % 2), cell * (rod / 2 % 2),
                                 0.1 + cell * (0.5 + layer));
    std::vector<Eigen::Vector3d> points{middle};
    Eigen::Vector3d direction = random.direction();
    for (int i = 0; i < edges; ++i) {
      points.push_back(points.back() + 0.4 * cell / edges * direction);
      direction = (direction + 0.2 * random.direction()).normalized();
    }
    rods.add(points, radius, section);
    const Eigen::Vector3d velocity = speed * random.direction();
    for (std::uint32_t i = rods.first(rods.count() - 1); i < rods.positions.size(); ++i) {
      rods.velocities[i] = velocity;
    }
  }
  return rods;
}

/// Whether steps end after one to three iterations, or go on until they balance. In those that
/// balance, presets, the integrator and the restitution are drawn, too.
enum class Iterations { FEW, ENOUGH };

class RandomSceneMaker {
 public:
  explicit RandomSceneMaker(Random& random, Iterations iterations = Iterations::FEW)
      : random_(random), is_balanced_(iterations == Iterations::ENOUGH) {}

  RandomScene make() {
    scene_.rods = random_rods_apart(random_, 0.3, preset());
    add_effects();
    add_contacts();
    if (!is_balanced_) {
      scene_.options.max_iterations = static_cast<std::uint32_t>(random_.integer(1, 3));
    } else if (chance("bdf2", 0.5)) {
      scene_.options.integrator = Integrator::BDF2;
    }
    scene_.step = std::pow(10.0, random_.uniform(-3.0, -1.7));
    text_ << scene_.rods.count() << " rods, " << scene_.options.max_iterations
          << " iterations, step " << scene_.step;
    scene_.description = text_.str();
    return std::move(scene_);
  }

 private:
  std::optional<RodMaterial> preset() {
    const auto names = material_names();
    if (!is_balanced_ || random_.chance(0.5)) {
      return std::nullopt;
    }
    const std::string& name = names[random_.integer(0, static_cast<int>(names.size()) - 1)];
    text_ << name << " ";
    return material_preset(name);
  }

  bool chance(const char* name, double probability) {
    const bool is = random_.chance(probability);
    text_ << (is ? name : "") << (is ? " " : "");
    return is;
  }

  void add(std::unique_ptr<Effect> effect) { scene_.effects.push_back(std::move(effect)); }

  template <class Make>
  void maybe(const char* name, const Make& make) {
    if (chance(name, 0.6)) {
      add(make());
    }
  }

  void add_effects() {
    Rods& rods = scene_.rods;
    scene_.is_inextensible = chance("inextensible", 0.3);
    if (scene_.is_inextensible) {
      add(std::make_unique<Inextensible>(rods));
    } else {
      // Rods that nothing keeps from shrinking to a point have no balance to find.
      if (chance("stretch", is_balanced_ ? 1.0 : 0.6)) {
        add(std::make_unique<Stretch>());
      }
    }
    maybe("gravity",
          [] { return std::make_unique<Gravity>(Eigen::Vector3d(0, 0, -standard_gravity)); });
    maybe("bend", [] { return std::make_unique<Bend>(); });
    maybe("twist", [&] { return std::make_unique<Twist>(rods); });
    maybe("damping",
          [&] { return std::make_unique<Damping>(std::pow(10.0, random_.uniform(-4.0, 0.0))); });
    maybe("plasticity", [&] { return std::make_unique<Plasticity>(rods, Plasticity::Options{}); });
    if (chance("drag", 0.3)) {
      scene_.is_windy = true;
      Drag::Options wind;
      wind.wind.mean = random_.in_cube(5.0);
      add(std::make_unique<Drag>(wind));
    }
    maybe("attachment", [&] {
      const auto node = static_cast<std::uint32_t>(random_.integer(0, 1)) * rods.node_count(0) / 2;
      return hold(rods, {pin(node, rods.positions[node])});
    });
  }

  void add_contacts() {
    std::vector<std::unique_ptr<ContactSource>> sources;
    const double restitution = is_balanced_ ? random_.uniform(0.0, 1.0) : default_restitution;
    sources.push_back(
        std::make_unique<FiberContact>(FiberContact::Options{Pairing::ALL, 0.0, restitution}));
    if (chance("table", 0.6)) {
      sources.push_back(std::make_unique<EnvironmentContact>(
          environment_of(HalfSpaceShape{}), EnvironmentContact::Options{0.0, {}, restitution}));
      scene_.has_table = true;
    }
    std::unique_ptr<Friction> friction;
    if (chance("friction", 0.6)) {
      scene_.has_friction = true;
      friction = std::make_unique<Friction>(Friction::Options{random_.uniform(0.0, 1.0), 1e-3});
    }
    scene_.contacts = std::make_unique<Contacts>(std::move(sources), std::move(friction));
  }

  Random& random_;
  bool is_balanced_;
  RandomScene scene_;
  std::ostringstream text_;
};

/// The energy of rods that touch nothing yet [J].
inline double energy_at_start(const Effects& effects, Rods& rods, double step) {
  begin(effects, rods, step);
  double energy = kinetic_energy(rods);
  for (const Effect* effect : storing_of(effects)) {
    energy += energy_of(*effect, rods);
  }
  return energy;
}

/// The kinetic energy of how speeds have changed [J].
inline double energy_of_change(Rods rods, const Rods& before) {
  for (std::size_t i = 0; i < rods.velocities.size(); ++i) {
    rods.velocities[i] -= before.velocities[i];
  }
  for (std::size_t i = 0; i < rods.spins.size(); ++i) {
    rods.spins[i] -= before.spins[i];
  }
  return kinetic_energy(rods);
}

/// Not to move at all would leave the incremental potential that there was of kinetic and stored
/// energy, and no step ends higher, however few its iterations are. So what is stored after it, and
/// half the square of how speeds have changed, are no more than there was: a step that is cut short
/// may gain energy only by that much. Impacts, which change speeds once more, give back no more
/// than the step has taken. Where such a step has friction or impacts, too, there is no such bound:
/// friction changes the potential of a step with its normal forces, impacts the speeds.
inline testing::AssertionResult gains_no_more_than_it_may(const Stepper& stepper,
                                                          const Rods& before, bool has_friction,
                                                          double slack) {
  const double gain = stepper.report().energy_gain;
  if (stepper.report().unbalanced > 0 && (has_friction || stepper.report().impacts > 0)) {
    return testing::AssertionSuccess();
  }
  double most = kinetic_energy(stepper.rods()) - energy_of_change(stepper.rods(), before) + slack;
  if (stepper.report().impacts > 0) {
    most = std::max(most, slack);
  }
  if (gain <= most) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "gains " << gain << " J, at most were " << most << " J";
}

}  // namespace fiber::test
