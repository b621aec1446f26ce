// Whatever a scene asks for, rods stay somewhere: no number that is none, and no more energy than
// was put in.

#include <gtest/gtest.h>

#include <sstream>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/energy_bounds.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

::testing::AssertionResult all_finite(const Rods& rods) {
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    if (!rods.positions[i].allFinite() || !rods.velocities[i].allFinite() ||
        (!rods.angles.empty() &&
         !(std::isfinite(rods.angles[i]) && std::isfinite(rods.spins[i])))) {
      return ::testing::AssertionFailure() << "node " << i;
    }
  }
  return ::testing::AssertionSuccess();
}

/// A rod that runs back along itself at some of its nodes.
std::vector<Vector3d> folded_chain(Random& random, int nodes, double edge_length) {
  std::vector<Vector3d> points = random_chain(random, nodes, edge_length);
  for (std::size_t i = 2; i < points.size(); ++i) {
    if (random.chance(0.3)) {
      points[i] = points[i - 2] + (random.chance(0.5) ? 1e-9 : 0.0) * random.in_cube();
    }
  }
  return points;
}

struct RandomScene {
  Rods rods;
  Effects effects;
  bool is_windy = false;
  StepperOptions options;
  double step;
  std::string description;
};

RandomScene random_scene(Random& random) {
  RandomScene scene;
  std::ostringstream text;
  const int count = random.integer(1, 3);
  for (int rod = 0; rod < count; ++rod) {
    const RodMaterial material{std::pow(10.0, random.uniform(4.0, 12.0)),
                               std::pow(10.0, random.uniform(4.0, 12.0)),
                               std::pow(10.0, random.uniform(2.0, 4.0))};
    const double length = std::pow(10.0, random.uniform(-2.0, 1.0));
    const double radius = length * std::pow(10.0, random.uniform(-4.0, -1.5));
    const int nodes = random.integer(2, 40);
    const bool is_folded = random.chance(0.3);
    scene.rods.add(is_folded ? folded_chain(random, nodes, length / nodes)
                             : random_chain(random, nodes, length / nodes),
                   radius, solid_round_section(material, radius));
    text << nodes << " nodes, length " << length << ", radius " << radius << ", E "
         << material.youngs_modulus << (is_folded ? ", folded; " : "; ");
  }
  const auto maybe = [&](const char* name, auto make) {
    if (random.chance(0.7)) {
      text << name << ' ';
      scene.effects.push_back(make());
    }
  };
  maybe("twist", [&] { return std::make_unique<Twist>(scene.rods); });
  displace(scene.rods, random, 0.0, 3.0);
  maybe("gravity", [&] { return std::make_unique<Gravity>(gravity); });
  maybe("stretch", [&] { return std::make_unique<Stretch>(); });
  maybe("bend", [&] { return std::make_unique<Bend>(); });
  maybe("damping",
        [&] { return std::make_unique<Damping>(std::pow(10.0, random.uniform(-4.0, 1.0))); });
  maybe("drag", [&] {
    scene.is_windy = true;
    Drag::Options options;
    options.fluid_density = std::pow(10.0, random.uniform(0.0, 3.0));
    options.wind = {random.in_cube(5.0), random.in_cube(5.0), 0.3, 1.0};
    return std::make_unique<Drag>(options);
  });
  maybe("holds", [&] {
    auto held = std::make_unique<Attachment>();
    for (std::uint32_t rod = 0; rod < scene.rods.count(); ++rod) {
      const Vector3d tangent = random.direction();
      const Placement placement{scene.rods.positions[scene.rods.first(rod)], tangent,
                                tangent.unitOrthogonal()};
      Attachment::Hold hold = random.chance(0.5) ? clamp(0, placement) : pin(0, placement.position);
      hold.rod = rod;
      held->add(scene.rods, hold);
    }
    return held;
  });
  scene.options.max_iterations = random.chance(0.5) ? 20 : random.integer(1, 3);
  scene.options.threads = 1;
  if (random.chance(0.5)) {
    scene.options.integrator = Integrator::BDF2;
    text << ", BDF2";
  }
  scene.step = std::pow(10.0, random.uniform(-3.0, -1.5));
  text << ", " << scene.options.max_iterations << " iterations, step " << scene.step;
  scene.description = text.str();
  return scene;
}

TEST(Robustness, RandomScenesStayBounded) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < rounds(30); ++round) {
    RandomScene scene = random_scene(random);
    SCOPED_TRACE("round " + std::to_string(round) + ": " + scene.description);
    begin(scene.effects, scene.rods, scene.step);
    EnergyBounds bounds(scene.rods, storing_of(scene.effects), scene.options.integrator);
    Stepper stepper(std::move(scene.rods), std::move(scene.effects), scene.options);
    const int steps = round == 0 ? 5000 : 100;
    for (int i = 0; i < steps; ++i) {
      stepper.step(scene.step);
      ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
      const testing::AssertionResult is_bounded = bounds.hold(stepper.rods());
      ASSERT_TRUE(scene.is_windy || is_bounded) << "step " << i << ", " << is_bounded.message();
    }
  }
}

/// A rod on a pin, stiff, heavy or not: its energy never exceeds what it began with.
TEST(Robustness, StiffAndFoldedRodsGainNoEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int round = 0; round < 30; ++round) {
    const double length = std::pow(10.0, random.uniform(-2.0, 1.0));
    const double radius = length * std::pow(10.0, random.uniform(-3.0, -1.5));
    const RodMaterial material{1e10, 4e9, std::pow(10.0, random.uniform(2.0, 4.0))};
    const int nodes = round == 0 ? 301 : random.integer(2, 30);
    Rods rods;
    rods.add(round % 2 == 0 ? folded_chain(random, nodes, length / nodes)
                            : random_chain(random, nodes, length / nodes),
             radius, solid_round_section(material, radius));
    const double step = std::pow(10.0, random.uniform(-3.0, -1.5));
    SCOPED_TRACE("round " + std::to_string(round) + ": " + std::to_string(nodes) +
                 " nodes, length " + std::to_string(length) + ", radius " + std::to_string(radius) +
                 ", step " + std::to_string(step));
    auto held = hold(rods, {pin(0, rods.positions[0])});
    Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                          std::make_unique<Gravity>(gravity));
    all.push_back(std::move(held));
    begin(all, rods, step);
    EnergyBounds bounds(rods, storing_of(all), Integrator::IMPLICIT_EULER);
    StepperOptions options;
    options.threads = 1;
    Stepper stepper(rods, std::move(all), options);
    const int steps = round == 1 ? 5000 : 100;
    for (int i = 0; i < steps; ++i) {
      stepper.step(step);
      ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
      ASSERT_TRUE(bounds.hold(stepper.rods())) << "step " << i;
    }
  }
}

/// Where nothing resists stretch, edges shrink to nothing and come out on the other side of what
/// clamps them, where their energies are others: no step may gain by that.
TEST(Robustness, EdgesThatTurnThroughTheirClampsGainNoEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  for (int round = 0; round < 30; ++round) {
    Rods rods;
    rods.add(random_chain(random, random.integer(2, 5), 0.1), 0.01, random_section(random));
    Effects all = effects(std::make_unique<Gravity>(gravity));
    if (round % 2 == 0) {
      all.push_back(std::make_unique<Twist>(rods));
    }
    const Vector3d tangent = random.direction();
    all.push_back(hold(rods, {clamp(0, {rods.positions[0], tangent, tangent.unitOrthogonal()})}));
    constexpr double step = 0.02;
    begin(all, rods, step);
    EnergyBounds bounds(rods, storing_of(all), Integrator::IMPLICIT_EULER);
    Stepper stepper(rods, std::move(all));
    for (int i = 0; i < 100; ++i) {
      stepper.step(step);
      ASSERT_TRUE(bounds.hold(stepper.rods())) << "round " << round << ", step " << i;
    }
  }
}

/// A gripper that is at 5 m/s at once, and stops as suddenly, after a metre.
TEST(Robustness, AFastGripperDragsARodAlong) {
  for (const bool has_twist : {false, true}) {
    for (const int nodes : {2, 3, 51, 1001}) {
      SCOPED_TRACE(std::to_string(nodes) + " nodes" + (has_twist ? ", with twist" : ""));
      Rods rods;
      rods.add(straight({0, 0, 0}, {1, 0, 0}, nodes - 1), 0.005,
               solid_round_section({1e9, 4e8, 1000.0}, 0.005));
      Effects all = effects(std::make_unique<Gravity>(gravity), std::make_unique<Stretch>(),
                            std::make_unique<Bend>(), std::make_unique<Damping>(0.01));
      if (has_twist) {
        all.push_back(std::make_unique<Twist>(rods));
      }
      const auto path =
          [director = Vector3d(has_twist ? rods.directors[0] : Vector3d::UnitY())](double time) {
            return Placement{{0.0, std::min(1.0, 5.0 * time), 0.0}, Vector3d::UnitX(), director};
          };
      all.push_back(hold(rods, {{0, 0, Attachment::Kind::CLAMP, path}}));
      StepperOptions options;
      options.threads = 1;
      Stepper stepper(rods, std::move(all), options);
      for (int i = 0; i < 120; ++i) {
        stepper.step(1.0 / 240.0);
        ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
        double length = 0.0;
        for (int node = 0; node + 1 < nodes; ++node) {
          length += (stepper.rods().positions[node + 1] - stepper.rods().positions[node]).norm();
        }
        ASSERT_LT(length, 1.5) << "step " << i;
      }
      EXPECT_NEAR(stepper.rods().positions[0].y(), 1.0, 1e-7);
    }
  }
}

/// Twist of the first rod at an inner node, by the moment that it takes [rad].
double twist_at(const Stepper& stepper, std::uint32_t node) {
  const Rods& rods = stepper.rods();
  return stepper.forces().twisting_moments[node] * rods.rest_length_at(node) /
         rods.sections[0].twisting_stiffness;
}

/// An edge that is brought to nothing and back has its section as it was.
TEST(Robustness, AnEdgeWithoutLengthKeepsItsDirector) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {3, 0, 0}, 3), 0.01, {1.0, 0.1, 0.1, 1.0, 1e-2});
  auto twist = std::make_unique<Twist>(rods);
  rods.angles[1] = 0.5;
  const Vector3d director = rods.directors[1];
  const auto path = [](double time) {
    return Placement{{1.0 + std::max(0.0, 1.0 - 10.0 * std::min(time, 0.4 - time)), 0.0, 0.0},
                     Vector3d::Zero(),
                     Vector3d::Zero()};
  };
  auto held = hold(rods, {pin(1, Vector3d::UnitX()), {0, 2, Attachment::Kind::PIN, path}});
  Stepper stepper(rods, effects(std::move(twist), std::move(held)));
  for (int i = 0; i < 40; ++i) {
    stepper.step(0.01);
    EXPECT_TRUE(stepper.rods().directors[1].isApprox(director, 1e-12)) << "step " << i;
    for (std::uint32_t node = 1; node < 3; ++node) {
      const double turned = stepper.rods().angles[node] - stepper.rods().angles[node - 1];
      EXPECT_NEAR(twist_at(stepper, node), turned, 1e-12) << "step " << i;
    }
  }
}

/// Any number of turns between two clamps stays when the rod is evaluated.
TEST(Robustness, TwistCountsItsTurns) {
  constexpr int segments = 20;
  constexpr double turns = 3.0;
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, {1e4, 100.0, 0.5, 1.0, 1e-4});
  auto twist = std::make_unique<Twist>(rods);
  const Vector3d director = rods.directors[0];
  const auto screw = [director](double time) {
    const Eigen::AngleAxisd turn(2.0 * M_PI * turns * std::min(time, 1.0), Vector3d::UnitX());
    return Placement{Vector3d::UnitX(), Vector3d::UnitX(), turn * director};
  };
  auto held = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), director}),
                          {0, segments, Attachment::Kind::CLAMP, screw}});
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::move(held)),
                  precise());
  for (int i = 0; i < 300; ++i) {
    stepper.step(0.01);
  }
  for (std::uint32_t node = 1; node < segments; ++node) {
    EXPECT_NEAR(twist_at(stepper, node), 2.0 * M_PI * turns / segments, 1e-3);
  }
}

}  // namespace
}  // namespace fiber::test
