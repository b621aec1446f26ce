// Nothing passes through anything, whatever is thrown, pulled or tied; and nothing blows up.

#include "test/sim/tunnelling.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test/sim/random_rods.hpp"
#include "test/sim/throw.hpp"
#include "test/sim/trefoil.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Steps, and looks each time whether axes have met.
void run(Stepper& stepper, int steps, double length) {
  TunnellingChecker checker(stepper.rods());
  for (int i = 0; i < steps; ++i) {
    stepper.step(length);
    ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
    ASSERT_EQ(checker.check(stepper.rods()), "") << "step " << i;
  }
}

/// The stored energy of rods that have not moved yet, contacts included [J].
double energy_at_rest(Rods rods) {
  for (Vector3d& velocity : rods.velocities) {
    velocity.setZero();
  }
  // In such a short step nothing moves.
  Stepper stepper(rods, elastic(), StepperOptions{}, contacts_with(nullptr));
  stepper.step(1e-12);
  return stepper.energy();
}

TEST(TunnellingChecker, SeesWhatPassesThroughAndNothingElse) {
  const auto edge = [](const Vector3d& from, const Vector3d& to, const Vector3d& by) {
    return MovingEdge{{from, to}, {from + by, to + by}};
  };
  const Vector3d x = Vector3d::UnitX();
  const Vector3d y = Vector3d::UnitY();
  const Vector3d z = Vector3d::UnitZ();
  const MovingEdge still = edge(-x, x, Vector3d::Zero());
  EXPECT_TRUE(meet(still, edge(-y + z, y + z, -2.0 * z)));
  EXPECT_TRUE(meet(still, edge(-y + z, y + z, -100.0 * z)));
  EXPECT_FALSE(meet(still, edge(-y + z, y + z, -0.999 * z)));
  EXPECT_FALSE(meet(still, edge(-y + z, y + z, 2.0 * x)));
  EXPECT_FALSE(meet(still, edge(1.01 * x - y + z, 1.01 * x + y + z, -2.0 * z)));
  EXPECT_TRUE(meet(still, edge(-x + y, x + y, -2.0 * y))) << "parallel";
  EXPECT_TRUE(meet(still, {{-0.5 * y + 0.1 * z, 0.5 * y - 0.1 * z + z},
                           {-0.5 * y - 0.1 * z, 0.5 * y - 0.2 * z}}));
}

TEST(Tunnelling, OfRodsThrownAtEachOther) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (const double speed : {1.0, 10.0, 50.0}) {
    for (const double radius : {0.0005, 0.005}) {
      for (int repeat = 0; repeat < 4; ++repeat) {
        SCOPED_TRACE("speed " + std::to_string(speed) + ", radius " + std::to_string(radius));
        Rods rods;
        for (int rod = 0; rod < 4; ++rod) {
          const Vector3d away = (0.15 + 0.1 * rod) * random.direction();
          rods.add(chain(random, away, 8, 0.3), radius, rubber(radius));
          for (std::uint32_t node = rods.first(rod); node < rods.end(rod); ++node) {
            rods.velocities[node] = -speed * away.normalized();
          }
        }
        // They are bent, and some may touch from the beginning.
        const double kinetic = kinetic_energy(rods);
        const double stored = energy_at_rest(rods);
        const Throw thrown(rods, elastic(), contacts_with(nullptr, 0.3));
        thrown.run(40, 1.0 / 60.0);
        EXPECT_LE(thrown.stepper->energy(), (kinetic + stored) * (1.0 + 1e-6));
      }
    }
  }
}

TEST(Tunnelling, OfARodWhoseEdgesHaveBeenThrownTogether) {
  // Between the two that meet, edges are for the moment so short that less of the rod lies there
  // than it can be bent in.
  constexpr double radius = 0.002;
  const std::vector<Vector3d> points{
      {-0.15, 0.0, 0.0},       {-0.1, 0.0, 0.0},      {-0.05, 0.0, 0.0},   {0.003, 0.0, 0.0},
      {0.002, -0.002, 0.0025}, {0.0, -0.003, 0.0045}, {0.0, 0.05, 0.0045}, {0.0, 0.1, 0.0045}};
  for (const double speed : {2.0, 5.0, 10.0, 20.0}) {
    SCOPED_TRACE("speed " + std::to_string(speed));
    Rods rods;
    rods.add(straight({0.0, 0.0, 0.0}, {0.35, 0.0, 0.0}, 7), radius, rubber(radius));
    rods.positions = points;
    for (std::uint32_t node = 4; node < 8; ++node) {
      rods.velocities[node].z() = -speed;
    }
    const Throw thrown(rods, elastic(), contacts_with(nullptr));
    thrown.run(20, 1.0 / 240.0);
  }
}

TEST(FreeFlight, OfRodsNearEachOtherIsNotSlowed) {
  // They fall together, further in a step than they are apart.
  constexpr double radius = 0.001;
  Rods rods;
  for (int rod = 0; rod < 5; ++rod) {
    const Vector3d start(0.0, 0.0, 0.0025 * rod);
    const Vector3d along(rod % 2 == 0 ? 0.2 : 0.05, rod % 2 == 0 ? 0.0 : 0.2, 0.0);
    rods.add(straight(start - along, start + along, 10), radius, rubber(radius));
  }
  Stepper stepper(rods, elastic(standard_gravity), StepperOptions{}, contacts_with(nullptr, 0.3));
  constexpr double step = 1.0 / 60.0;
  for (int i = 1; i <= 60; ++i) {
    stepper.step(step);
    for (const Vector3d& velocity : stepper.rods().velocities) {
      ASSERT_NEAR(velocity.z(), -standard_gravity * step * i, 1e-4) << "step " << i;
    }
  }
}

/// Holds a node of all rods, counted through, that moves at a constant speed from where it is.
Attachment::Hold gripper(const Rods& rods, std::uint32_t node, const Vector3d& velocity) {
  std::uint32_t rod = 0;
  while (node >= rods.end(rod)) {
    ++rod;
  }
  return {rod, node - rods.first(rod), Attachment::Kind::PIN,
          [start = rods.positions[node], velocity](double time) {
            return Placement{start + time * velocity, Vector3d::Zero(), Vector3d::Zero()};
          }};
}

Effects pulled(const Rods& rods, const std::vector<Attachment::Hold>& grippers,
               double gravity = 0.0) {
  Effects all = elastic(gravity);
  all.push_back(hold(rods, grippers));
  return all;
}

TEST(Tunnelling, OfARodThatGrippersPullAcrossAnother) {
  for (const double radius : {0.0005, 0.004}) {
    Rods rods;
    rods.add(straight({-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}, 20), radius, rubber(radius));
    rods.add(straight({0.01, -0.2, 0.02}, {0.02, 0.2, 0.02}, 20), radius, rubber(radius));
    const auto hold = [&rods](std::uint32_t node, const Vector3d& velocity) {
      return gripper(rods, node, velocity);
    };
    const Vector3d still = Vector3d::Zero();
    const Vector3d down(0.0, 0.0, -5.0);
    // Down across the other rod, and on until all holds pull with all their force.
    Stepper stepper(rods,
                    pulled(rods, {hold(0, still), hold(20, still), hold(21, down), hold(41, down)}),
                    StepperOptions{}, contacts_with(nullptr, 0.3));
    run(stepper, 30, 1.0 / 240.0);
    for (const RodForces::HoldForce& held : stepper.forces().holds) {
      EXPECT_NEAR(held.force.norm(), held.max_force, 1e-9 * held.max_force);
      EXPECT_GT(held.lag, 0.05);
    }
    // And sideways, so that it slides off.
    const Vector3d aside(5.0, 0.0, 0.0);
    Stepper sideways(
        rods, pulled(rods, {hold(0, still), hold(20, still), hold(21, aside)}, standard_gravity),
        StepperOptions{}, contacts_with(nullptr, 0.3));
    run(sideways, 60, 1.0 / 240.0);
  }
}

TEST(Tunnelling, OfAKnotThatIsTightened) {
  constexpr double radius = 0.004;
  const std::vector<Vector3d> points = open_trefoil(0.02, 60);
  Rods rods;
  rods.add(points, radius, rubber(radius));
  const auto last = static_cast<std::uint32_t>(points.size()) - 1;
  const Vector3d apart = (points.front() - points.back()).normalized();
  // Until it is tight, and as hard as the holds can.
  Stepper stepper(rods,
                  pulled(rods, {gripper(rods, 0, 0.4 * apart), gripper(rods, last, -0.4 * apart)}),
                  StepperOptions{}, contacts_with(nullptr, 0.3));
  run(stepper, 240, 1.0 / 240.0);
  for (const RodForces::HoldForce& held : stepper.forces().holds) {
    EXPECT_NEAR(held.force.norm(), held.max_force, 1e-9 * held.max_force);
    EXPECT_GT(held.lag, 0.05);
  }
}

TEST(Crossing, AtTheBeginningDoesNotBlowUp) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  for (int repeat = 0; repeat < 6; ++repeat) {
    Rods rods;
    const double radius = repeat % 2 == 0 ? 0.001 : 0.01;
    for (int rod = 0; rod < 3; ++rod) {
      const Vector3d half = 0.2 * random.direction();
      // Exactly through the origin, and so through each other.
      rods.add(straight(-half, half, 8), radius, rubber(radius));
    }
    // Folded: each edge on the one before.
    std::vector<Vector3d> folded;
    for (int i = 0; i < 9; ++i) {
      folded.emplace_back(0.5 + 0.03 * (i % 2), 0.0, 0.0);
    }
    rods.add(folded, radius, rubber(radius));
    Stepper stepper(rods, elastic(), StepperOptions{}, contacts_with(nullptr, 0.3));
    double most = 0.0;
    for (int i = 0; i < 300; ++i) {
      stepper.step(1.0 / 240.0);
      ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
      for (const Vector3d& velocity : stepper.rods().velocities) {
        most = std::max(most, velocity.norm());
      }
    }
    EXPECT_LT(most, 50.0);
    EXPECT_LT(kinetic_energy(stepper.rods()), 1.0);
  }
}

}  // namespace
}  // namespace fiber::test
