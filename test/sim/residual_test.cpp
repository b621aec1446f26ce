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
#include "test/sim/extra_scene.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double balance_step = 1.0 / 240.0;
constexpr double pressed_radius = 0.004;
constexpr double creep = 1e-3;    // [m/s] of what sticks
constexpr double friction = 0.4;  // coefficient

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

Effects effects_of(const ExtraScene& scene) {
  Effects all = elastic(standard_gravity);
  all.push_back(std::make_unique<Damping>(0.01));
  scene.add_effects(all);
  return all;
}

/// So stiff that no contact has more to hold than it does well: otherwise the solver makes them
/// stiffer.
/// @param begin where their time is 0 [s]
std::unique_ptr<Contacts> stiff_contacts(const ExtraScene& scene, double begin) {
  return scene.contacts(2e4, friction, begin);
}

/// The gradient of contacts and of friction after a step, node by node [N].
/// @param time    at the beginning of the step [s]
/// @param anchors of friction, from the step before; replaced by those after this one
std::vector<Vector3d> contact_gradient(const ExtraScene& scene, const Rods& before,
                                       const Rods& after, double time, FrictionAnchors& anchors) {
  const auto contacts = stiff_contacts(scene, time);
  const std::vector<std::uint32_t> together(after.count(), 0);
  if (ObstacleMotions* const motions = contacts->motions()) {
    motions->begin_step(0.0);
    motions->begin_solve(balance_step);
  }
  // The bound is farther than rods have gone.
  ContactSet found = contacts_of(*contacts, before, 3.0 * pressed_radius);
  if (contacts->motions() != nullptr) {
    found.begin_motion(together, 1);
  }
  found.begin(before, contacts->friction(), {&before, &anchors}, balance_step);
  if (MovedShapes* const moved = found.moved_shapes()) {
    moved->go_to(0, 1.0);
  }
  found.update_distances(after);
  found.update_friction(after, together, {1.0});
  found.find_derivatives(after);
  FrictionAnchors next;
  found.add_anchors(after, next);
  next.sort(after.positions.size());
  anchors = next;
  std::vector<PackSystem> packs(after.count());
  std::vector<RodSystem> systems;
  systems.reserve(after.count());
  std::vector<RodSystem*> pointers;
  for (std::uint32_t rod = 0; rod < after.count(); ++rod) {
    packs[rod].resize(after.node_count(rod), unknowns_of(after));
    packs[rod].set_zero();
    systems.emplace_back(packs[rod], 0);
    pointers.push_back(&systems.back());
  }
  add_derivatives(found.terms(), after, pointers, together, 0);
  std::vector<Vector3d> gradient;
  for (std::uint32_t rod = 0; rod < after.count(); ++rod) {
    for (std::size_t i = 0; i < after.node_count(rod); ++i) {
      const std::size_t x = unknowns_of(after) * i;
      gradient.emplace_back(systems[rod].gradient(x), systems[rod].gradient(x + 1),
                            systems[rod].gradient(x + 2));
    }
  }
  return gradient;
}

/// The gradient of what welds and closed rods store, node by node, by differences [N].
std::vector<Vector3d> weld_gradient(const ExtraScene& scene, Rods rods) {
  constexpr double difference = 1e-6;  // [m]
  std::vector<Vector3d> gradient(rods.positions.size(), Vector3d::Zero());
  const auto joints = scene.joints();
  if (joints == nullptr) {
    return gradient;
  }
  joints->begin_step(rods, {0.0, balance_step});
  for (std::size_t node = rods.first(4); node < gradient.size(); ++node) {
    for (Eigen::Index part = 0; part < 3; ++part) {
      double& x = rods.positions[node][part];
      const double middle = x;
      x = middle + difference;
      const double after = joints->stored_energy(rods);
      x = middle - difference;
      const double before = joints->stored_energy(rods);
      x = middle;
      gradient[node][part] = (after - before) / (2.0 * difference);
    }
  }
  return gradient;
}

/// The residual of each node's equation after a step from one state to another, as a change of
/// speed [m/s]. Nodes that are joined have that of their place together.
std::vector<double> residuals(const ExtraScene& scene, const Rods& before, const Rods& after,
                              double time, FrictionAnchors& anchors) {
  Effects effects = effects_of(scene);
  Rods start = before;
  begin(effects, start, balance_step);
  Rods now = after;  // angles are counted from the directors with which the step began
  now.directors = before.directors;
  now.start_tangents = before.start_tangents;
  const std::vector<Vector3d> of_contacts = contact_gradient(scene, before, now, time, anchors);
  const std::vector<Vector3d> of_welds = weld_gradient(scene, after);
  std::vector<Vector3d> forces;
  for (std::uint32_t rod = 0; rod < after.count(); ++rod) {
    std::vector<Vector3d> gradient(after.node_count(rod), Vector3d::Zero());
    for (const auto& effect : effects) {
      const VectorXd all = derivatives_of(*effect, now, rod).gradient;
      for (std::size_t i = 0; i < gradient.size(); ++i) {
        gradient[i] += all.segment<3>(static_cast<Eigen::Index>(unknowns_of(now) * i));
      }
    }
    for (const Vector3d& each : gradient) {
      forces.emplace_back(-each - of_contacts[forces.size()] - of_welds[forces.size()]);
    }
  }
  std::vector<double> left;
  for (std::size_t node = 0; node < forces.size(); ++node) {
    Vector3d force = forces[node];
    double mass = after.masses[node];
    for (std::size_t other = 0; !after.joints.empty() && other < forces.size(); ++other) {
      if (other != node && after.joints[node] >= 0 && after.joints[other] == after.joints[node]) {
        force += forces[other];
        mass += after.masses[other];
      }
    }
    const auto change_of = [&](std::size_t i) -> Vector3d {
      return after.velocities[i] - before.velocities[i];
    };
    // What a bar has beyond the half of its mass at each end, and how little an end of it resists.
    for (const std::size_t edge : {node, node - 1}) {
      if (edge < forces.size() && after.is_rigid(static_cast<std::uint32_t>(edge))) {
        const std::size_t other = 2 * edge + 1 - node;
        const double coupling = after.mass_couplings[edge];
        force += coupling * (change_of(node) - change_of(other)) / balance_step;
        const double others = after.masses[other] - coupling;
        const double resists = mass - coupling - coupling * coupling / others;
        force += (resists - mass) * change_of(node) / balance_step;
        mass = resists;
      }
    }
    left.push_back((balance_step * force / mass - change_of(node)).norm());
  }
  return left;
}

/// By how much friction may change the speed of each node in a step beyond the residual: it may be
/// off by 2 % of what it is where all of a contact slides [m/s].
std::vector<double> left_by_friction(const Stepper& stepper) {
  constexpr double most_off = 0.02;
  const Rods& rods = stepper.rods();
  std::vector<double> left(rods.positions.size(), 0.0);
  for (const RodForces::ContactForce& contact : stepper.forces().contacts) {
    const auto add = [&](std::uint32_t rod, std::uint32_t edge) {
      for (const std::uint32_t node : {rods.first(rod) + edge, rods.first(rod) + edge + 1}) {
        left[node] +=
            most_off * friction * contact.normal_force.norm() * balance_step / rods.masses[node];
      }
    };
    add(contact.rod, contact.edge);
    if (contact.other_rod != RodForces::ContactForce::obstacle) {
      add(contact.other_rod, contact.other_edge);
    }
  }
  return left;
}

class Residual : public testing::TestWithParam<Extra> {};

TEST_P(Residual, IsWhatIsLeftOfEachNodesEquation) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (const double residual : {1e-3, 1e-6}) {
    const ExtraScene scene(scene_of(random), GetParam(), 0.08);
    const Rods& rods = scene.rods();
    StepperOptions options;
    options.threads = 1;
    options.residual = residual;
    const auto go_on = [&](const Rods& from, double time) {
      return std::make_unique<Stepper>(from, effects_of(scene), options,
                                       stiff_contacts(scene, time), scene.joints());
    };
    double time = 0.0;
    std::unique_ptr<Stepper> stepper = go_on(rods, time);
    int balanced = 0;
    int still = 0;
    std::size_t contacts = 0;
    FrictionAnchors anchors;
    for (int i = 0; i < 480; ++i) {
      const Rods before = stepper->rods();
      stepper->step(balance_step);
      const std::vector<double> left = residuals(scene, before, stepper->rods(), time, anchors);
      time += balance_step;
      const StepReport& report = stepper->report();
      // Slips are kept by the energy that friction has in them: by what that is off adds up.
      constexpr int most_steps = 10;
      if (report.unbalanced > 0 || i % most_steps == 0) {
        // Friction was that of the forces before the last iteration, which nobody tells.
        stepper = go_on(stepper->rods(), time);
        anchors = FrictionAnchors();
        continue;
      }
      // Impacts change velocities beyond what the equations say, and midpoint normals the forces.
      if (report.impacts > 0 || report.midpoint_contacts > 0) {
        continue;
      }
      ++balanced;
      contacts = std::max(contacts, stepper->forces().contacts.size());
      const std::vector<double> by_friction = left_by_friction(*stepper);
      for (std::size_t node = 0; node < left.size(); ++node) {
        ASSERT_LE(left[node], residual + by_friction[node] + 1e-9)
            << "step " << i << ", node " << node;
        const Vector3d slip = stepper->rods().velocities[node] - scene.table_velocity();
        still += slip.norm() <= creep ? 1 : 0;
      }
    }
    expect_enough(balanced, 40);
    expect_enough(still, 500);
    expect_enough(contacts, std::size_t{20});
    EXPECT_LT(stepper->rods().positions[rods.first(3)].z() - scene.table_at(time).translation().z(),
              0.05)
        << "they have fallen";
  }
}

/// Few iterations leave something, which is told as the force of the integrator's own equation.
TEST(ResidualForce, IsWhatTheEquationOfTheIntegratorLeaves) {
  Random random(1);
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    Rods rods;
    rods.add(straight(Vector3d::Zero(), Vector3d::UnitX(), 6), 0.005, rubber(0.005));
    for (Vector3d& velocity : rods.velocities) {
      velocity = 3.0 * random.direction();
    }
    StepperOptions options;
    options.integrator = integrator;
    options.max_iterations = 1;
    Stepper stepper(rods, effects(std::make_unique<Stretch>()), options);
    std::vector<Rods> states;
    for (int i = 0; i < 5; ++i) {
      stepper.step(balance_step);
      states.push_back(stepper.rods());
    }
    const Rods& after = states.back();
    // BDF2: v − 4/3 v₁ + 1/3 v₂ = 2/3 of a step's change.
    const double weight = integrator == Integrator::BDF2 ? 1.0 / 3.0 : 0.0;
    const std::uint32_t node = stepper.report().worst.node;
    const Vector3d reference =
        (1.0 + weight) * states[3].velocities[node] - weight * states[2].velocities[node];
    const Vector3d left =
        -derivatives_of(Stretch(), after, 0).gradient.segment<3>(3 * node) -
        after.masses[node] * (after.velocities[node] - reference) / ((1.0 - weight) * balance_step);
    EXPECT_EQ(stepper.report().unbalanced, 1U);
    EXPECT_NEAR(stepper.report().worst.residual_force, left.norm(), 1e-6 * left.norm()) << weight;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Residual,
                         testing::Values(Extra::NONE, Extra::LOADS, Extra::MOMENT, Extra::SECTIONS,
                                         Extra::BALL, Extra::WELD, Extra::CLOSED, Extra::LIFT,
                                         Extra::STRIPS),
                         [](const auto& extra) { return name_of(extra.param); });

/// A thin stiff rod that hangs from one end, let go level, in steps of 1/240 s.
struct ThinRodRun {
  int unbalanced = 0;
  std::uint32_t median_iterations = 0;
};

ThinRodRun swing_thin_rod(const char* preset, double radius, Integrator integrator) {
  Rods rods;
  rods.add(straight(Vector3d::Zero(), {0.1, 0, 0}, 50), radius,
           solid_round_section(material_preset(preset), radius));
  StepperOptions options;
  options.integrator = integrator;
  options.threads = 1;
  Stepper stepper(
      rods,
      effects(std::make_unique<Gravity>(Vector3d(0, 0, -9.81)), std::make_unique<Stretch>(),
              std::make_unique<Bend>(), hold(rods, {pin(0, Vector3d::Zero())})),
      options);
  ThinRodRun run;
  std::vector<std::uint32_t> iterations;
  for (int i = 0; i < 240; ++i) {
    stepper.step(balance_step);
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
