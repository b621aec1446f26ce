// Forces balance where the solver says so, by a sum of forces that the solver has no part in:
// each node's mass times how its velocity changes in a step is what acts on it, to the stated
// residual.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/contact_system.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/energy_bounds.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double balance_step = 1.0 / 240.0;
constexpr double pressed_radius = 0.004;
constexpr double creep = 1e-3;  // [m/s] of what sticks

/// Rods across each other, and one that is rolled up, above a table.
Rods scene_of(Random& random) {
  Rods rods;
  std::vector<Vector3d> coil;
  for (int i = 0; i <= 24; ++i) {
    const double angle = 0.5 * i;
    coil.emplace_back(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.006 + 0.0016 * angle);
  }
  rods.add(coil, pressed_radius, rubber(pressed_radius));
  for (int rod = 0; rod < 3; ++rod) {
    const double turn = random.uniform(0.0, 2.0 * M_PI);
    const Vector3d along(0.1 * std::cos(turn), 0.1 * std::sin(turn), 0.0);
    const Vector3d middle(0.0, 0.0, 0.04 + 0.01 * rod);
    rods.add(straight(middle - along, middle + along, 12), pressed_radius, rubber(pressed_radius));
  }
  return rods;
}

Effects effects_of_scene() {
  Effects all = elastic(standard_gravity);
  all.push_back(std::make_unique<Damping>(0.01));
  return all;
}

/// So stiff that no contact has more to hold than it does well: otherwise the solver makes them
/// stiffer.
std::unique_ptr<Contacts> stiff_contacts(const std::shared_ptr<const Environment>& environment) {
  constexpr double stiffness = 2e4;  // [N/m]
  std::vector<std::unique_ptr<ContactSource>> sources;
  FiberContact::Options fiber;
  fiber.stiffness = stiffness;
  sources.push_back(std::make_unique<FiberContact>(fiber));
  EnvironmentContact::Options obstacle;
  obstacle.stiffness = stiffness;
  sources.push_back(std::make_unique<EnvironmentContact>(environment, obstacle));
  return std::make_unique<Contacts>(std::move(sources),
                                    std::make_unique<Friction>(Friction::Options{0.4, 1e-3}));
}

/// The residual of each node's equation after a step from one state to another, as a change of
/// speed [m/s].
/// @param anchors of friction, from the step before; replaced by those after this one
std::vector<double> residuals(const Rods& before, const Rods& after,
                              const std::shared_ptr<const Environment>& environment,
                              FrictionAnchors& anchors) {
  Effects effects = effects_of_scene();
  Rods start = before;
  begin(effects, start, balance_step);
  const auto contacts = stiff_contacts(environment);
  // The bound is farther than rods have gone.
  ContactSet found = contacts_of(*contacts, before, pressed_radius);
  found.begin(before, contacts->friction(), {&before, &anchors}, balance_step);
  found.update_distances(after);
  found.update_friction(after, std::vector<std::uint32_t>(after.count(), 0), {true});
  found.find_derivatives(after);
  FrictionAnchors next;
  found.add_anchors(after, next);
  next.sort(after.positions.size());
  std::vector<PackSystem> packs(after.count());
  std::vector<RodSystem> systems;
  systems.reserve(after.count());
  std::vector<RodSystem*> pointers;
  for (std::uint32_t rod = 0; rod < after.count(); ++rod) {
    packs[rod].resize(after.node_count(rod), 3);
    packs[rod].set_zero();
    systems.emplace_back(packs[rod], 0);
    pointers.push_back(&systems.back());
  }
  add_derivatives(found.terms(), after, pointers, std::vector<std::uint32_t>(after.count(), 0), 0);
  anchors = next;
  std::vector<double> left;
  for (std::uint32_t rod = 0; rod < after.count(); ++rod) {
    VectorXd gradient = VectorXd::Zero(3 * after.node_count(rod));
    for (const auto& effect : effects) {
      gradient += derivatives_of(*effect, after, rod).gradient;
    }
    for (std::uint32_t i = 0; i < after.node_count(rod); ++i) {
      const std::uint32_t node = after.first(rod) + i;
      Vector3d force = -gradient.segment<3>(3 * Eigen::Index{i});
      for (std::size_t k = 0; k < 3; ++k) {
        force[static_cast<Eigen::Index>(k)] -= systems[rod].gradient(std::size_t{3} * i + k);
      }
      const Vector3d change = after.velocities[node] - before.velocities[node];
      left.push_back((balance_step * force / after.masses[node] - change).norm());
    }
  }
  return left;
}

TEST(Residual, IsWhatIsLeftOfEachNodesEquation) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (const double residual : {1e-3, 1e-6}) {
    const Rods rods = scene_of(random);
    const auto environment = environment_of(HalfSpaceShape{});
    StepperOptions options;
    options.threads = 1;
    options.residual = residual;
    Stepper stepper(rods, effects_of_scene(), options, stiff_contacts(environment));
    int balanced = 0;
    int still = 0;
    std::size_t contacts = 0;
    FrictionAnchors anchors;
    for (int i = 0; i < 480; ++i) {
      const Rods before = stepper.rods();
      stepper.step(balance_step);
      const std::vector<double> left = residuals(before, stepper.rods(), environment, anchors);
      // Impacts change velocities beyond what the equations say.
      if (stepper.report().unbalanced > 0 || stepper.report().impacts > 0 || i % 10 != 0) {
        continue;
      }
      ++balanced;
      contacts = std::max(contacts, stepper.forces().contacts.size());
      for (std::size_t node = 0; node < left.size(); ++node) {
        ASSERT_LE(left[node], 1.01 * residual + 1e-9) << "step " << i << ", node " << node;
        still += stepper.rods().velocities[node].norm() <= creep ? 1 : 0;
      }
    }
    expect_enough(balanced, 40);
    expect_enough(still, 500);
    expect_enough(contacts, std::size_t{20});
    EXPECT_LT(stepper.rods().positions[rods.first(3)].z(), 0.05) << "they have fallen";
  }
}

/// A thin stiff rod that hangs from one end, let go level, in steps of 1/240 s.
struct ThinRodRun {
  int unbalanced = 0;
  std::uint32_t median_iterations = 0;
};

ThinRodRun swing_thin_rod(const char* preset, double radius, Integrator integrator) {
  Rods rods;
  rods.add(straight(Eigen::Vector3d::Zero(), {0.1, 0, 0}, 50), radius,
           solid_round_section(material_preset(preset), radius));
  auto pinned = hold(rods, {pin(0, Eigen::Vector3d::Zero())});
  StepperOptions options;
  options.integrator = integrator;
  options.threads = 1;
  Stepper stepper(rods,
                  effects(std::make_unique<Gravity>(Eigen::Vector3d(0, 0, -9.81)),
                          std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(pinned)),
                  options);
  ThinRodRun run;
  std::vector<std::uint32_t> iterations;
  for (int i = 0; i < 240; ++i) {
    stepper.step(1.0 / 240.0);
    run.unbalanced += stepper.report().unbalanced > 0 ? 1 : 0;
    iterations.push_back(stepper.report().iterations);
  }
  std::nth_element(iterations.begin(), iterations.begin() + 120, iterations.end());
  run.median_iterations = iterations[120];
  return run;
}

TEST(ThinRods, Balance) {
  for (const char* const preset : {"power_cable", "rope", "silicone_tube", "hair"}) {
    for (const double radius : {1e-5, 3e-5, 1e-4}) {
      for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
        const ThinRodRun run = swing_thin_rod(preset, radius, integrator);
        EXPECT_LE(run.unbalanced, 2) << preset << ", " << radius;
        EXPECT_LE(run.median_iterations, 20U) << preset << ", " << radius;
      }
    }
  }
}

}  // namespace
}  // namespace fiber::test
