// Forces, moments, weights and velocities to begin with.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/error_of.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

using Forces = TimeTable<Vector3d>;

Vector3d momentum_under_loads(const Rods& rods) {
  return std::inner_product(rods.masses.begin(), rods.masses.end(), rods.velocities.begin(),
                            Vector3d(Vector3d::Zero()));
}

double mass_under_loads(const Rods& rods) {
  return std::accumulate(rods.masses.begin(), rods.masses.end(), 0.0);
}

Rods one_rod(int segments = 10) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, {1e4, 1.0, 0.8, 1.0, 1e-4});
  return rods;
}

Loads::Load force_at(std::uint32_t node, const Vector3d& force) {
  Loads::Load load;
  load.node = node;
  load.force = Forces(force);
  return load;
}

Loads::Load force_along(double from, double to, const Vector3d& force) {
  Loads::Load load;
  load.part = RodPart{from, to};
  load.force = Forces(force);
  return load;
}

/// A load of each kind, of random size.
void add_random_loads(Random& random, Rods& rods, Loads& loads) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    Loads::Load load = force_at(rods.node_count(rod) / 2, random.in_cube(3.0));
    load.rod = rod;
    loads.add(rods, load);
    load.node = rod % 2 == 0 ? 0 : rods.node_count(rod) - 1;
    load.moment = Forces(random.in_cube(2.0));
    load.torque = TimeTable<double>(rods.angles.empty() ? 0.0 : random.uniform(-1.0, 1.0));
    load.mass = random.uniform(0.0, 1.0);
    loads.add(rods, load);
    load.moment = Forces(Vector3d::Zero());
    double length = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      length += rods.rest_lengths[i];
    }
    load.part = RodPart{0.13 * length, 0.71 * length};
    loads.add(rods, load);
  }
}

TEST(AppliedLoads, DerivativesAreThoseOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(21);
  for (int round = 0; round < 20; ++round) {
    Rods rods = rods_of_equal_sizes(random, 3, random.integer(2, 9), 0.3);
    std::unique_ptr<Twist> twist;
    if (round % 2 == 0) {
      twist = std::make_unique<Twist>(rods);
    }
    Loads loads;
    add_random_loads(random, rods, loads);
    loads.begin_step(rods, {0.0, 0.01});
    displace(rods, random, 0.03, round % 2 == 0 ? 1.0 : 0.0);
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      const Eigen::VectorXd found = derivatives_of(loads, rods, rod).gradient;
      const Eigen::VectorXd expected = gradient_by_differences(loads, rods, rod, 1e-6);
      ASSERT_LE((found - expected).norm(), 1e-6 * (1.0 + expected.norm())) << "round " << round;
    }
    expect_same_side_by_side(loads, rods);
  }
}

/// What is spread over a part has its resultant and its moment about any point, wherever its ends
/// are between nodes.
TEST(AppliedLoads, APartHasItsForceMomentMassAndTorque) {
  SCOPED_TRACE(seed_message());
  Random random(22);
  for (int round = 0; round < 100; ++round) {
    Rods rods = one_rod();
    const Twist twist(rods);
    const double mass_before = mass_under_loads(rods);
    const double from = random.uniform(0.0, 0.9);
    const double to = random.uniform(from + 0.01, 1.0);
    Loads::Load load = force_along(from, to, random.in_cube(2.0));
    load.mass = random.uniform(0.1, 2.0);
    load.torque = TimeTable<double>(random.uniform(-1.0, 1.0));
    Loads loads;
    loads.add(rods, load);
    loads.begin_step(rods, {0.0, 0.01});
    const Eigen::VectorXd gradient = derivatives_of(loads, rods, 0).gradient;
    Vector3d force = Vector3d::Zero();
    Vector3d moment = Vector3d::Zero();
    double torque = 0.0;
    for (std::uint32_t i = 0; i < rods.node_count(0); ++i) {
      force -= gradient.segment<3>(4 * i);
      moment -= rods.positions[i].cross(gradient.segment<3>(4 * i));
      torque -= gradient[4 * i + 3];
    }
    const Vector3d spread = (to - from) * load.force.at(0.0);
    const Vector3d middle(0.5 * (from + to), 0.0, 0.0);
    EXPECT_LE((force - spread).norm(), 1e-12);
    EXPECT_LE((moment - middle.cross(spread)).norm(), 1e-12);
    EXPECT_NEAR(torque, (to - from) * load.torque.at(0.0), 1e-12);
    EXPECT_NEAR(mass_under_loads(rods) - mass_before, (to - from) * load.mass, 1e-12);
  }
}

/// A force in time, weights and velocities to begin with: each step changes the momentum by the
/// force at its end.
TEST(AppliedLoads, TheImpulseIsTheChangeOfMomentum) {
  Rods rods = one_rod();
  Loads::Load load = force_at(3, Vector3d::Zero());
  load.force =
      Forces({{0.0, {0.0, 0.0, 0.0}}, {0.1, {1.0, 2.0, -3.0}}, {0.15, {-2.0, 1.0, 0.0}}}, true);
  load.mass = 0.5;
  auto loads = std::make_unique<Loads>();
  loads->add(rods, load);
  loads->add(rods, force_along(0.25, 0.8, {0.0, 0.3, 0.0}));
  for (Vector3d& velocity : rods.velocities) {
    velocity = Vector3d(1.0, 0.0, 2.0);
  }
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(loads)),
                  precise());
  constexpr double step = 0.01;
  Vector3d expected = momentum_under_loads(rods);
  for (int i = 0; i < 40; ++i) {
    stepper.step(step);
    expected += step * (load.force.at(stepper.time()) + Vector3d(0.0, 0.55 * 0.3, 0.0));
    ASSERT_LE((momentum_under_loads(stepper.rods()) - expected).norm(), 1e-10) << "step " << i;
    Vector3d told = Vector3d::Zero();
    for (const RodForces::LoadForce& each : stepper.forces().loads) {
      told += each.force;
    }
    ASSERT_LE((told - load.force.at(stepper.time()) - Vector3d(0.0, 0.165, 0.0)).norm(), 1e-12);
  }
}

/// A free rod under a couple and one under a torque: the rate of its angular momentum.
TEST(AppliedLoads, AMomentIsTheRateOfAngularMomentum) {
  Rods rods = one_rod();
  auto twist = std::make_unique<Twist>(rods);
  Loads::Load load;
  load.moment = Forces(Vector3d(0.0, 0.0, 0.02));
  Loads::Load torque;
  torque.part = RodPart{0.0, 1.0};
  torque.torque = TimeTable<double>(1e-4);
  auto loads = std::make_unique<Loads>();
  loads->add(rods, load);
  loads->add(rods, torque);
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::move(loads)),
                  precise());
  constexpr int steps = 20;
  constexpr double step = 1e-3;
  for (int i = 0; i < steps; ++i) {
    stepper.step(step);
  }
  Vector3d momentum = Vector3d::Zero();
  double spin = 0.0;
  const Rods& after = stepper.rods();
  for (std::uint32_t i = 0; i < after.node_count(0); ++i) {
    momentum += after.masses[i] * after.positions[i].cross(after.velocities[i]);
    spin += after.section_inertia(0, i) * after.spins[i];
  }
  EXPECT_NEAR(momentum.z(), 0.02 * steps * step, 1e-3 * 0.02 * steps * step);
  EXPECT_NEAR(spin, 1e-4 * steps * step, 1e-9 * steps * step);
  EXPECT_LE(momentum_under_loads(after).norm(), 1e-12) << "a couple moves nothing";
}

/// Of a moment that is oblique to the rod, all of it is in each cross-section at rest.
TEST(AppliedLoads, AnEndMomentIsInTheWholeRod) {
  Rods rods = one_rod(50);
  auto twist = std::make_unique<Twist>(rods);
  Loads::Load load;
  load.node = 50;
  load.moment = Forces(Vector3d(0.5, 0.6, 0.7));
  auto loads = std::make_unique<Loads>();
  loads->add(rods, load);
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), rods.directors[0]})});
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::move(clamped), std::move(loads)),
                  precise());
  for (int i = 0; i < 60; ++i) {
    stepper.step(0.2);
    std::fill(stepper.rods().velocities.begin(), stepper.rods().velocities.end(), Vector3d::Zero());
    std::fill(stepper.rods().spins.begin(), stepper.rods().spins.end(), 0.0);
  }
  const RodForces forces = stepper.forces();
  const std::vector<Vector3d>& positions = stepper.rods().positions;
  for (std::uint32_t i = 1; i < 50; ++i) {
    const Vector3d tangent = (positions[i + 1] - positions[i - 1]).normalized();
    const Vector3d moment = forces.bending_moments[i] + forces.twisting_moments[i] * tangent;
    EXPECT_LE((moment - load.moment.at(0.0)).norm(), 0.005) << "node " << i;
  }
  EXPECT_LE((forces.holds[0].moment + load.moment.at(0.0)).norm(), 0.005);
  EXPECT_LE((forces.loads[0].moment - load.moment.at(0.0)).norm(), 1e-12);
}

/// A constant force has a potential: the energy that a weight has lost it has given to the rod.
TEST(AppliedLoads, AConstantForceGivesBackItsWork) {
  Rods rods = one_rod();
  Loads::Load load = force_at(10, {0.0, 0.0, -2.0});
  load.mass = 0.3;
  auto loads = std::make_unique<Loads>();
  loads->add(rods, load);
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})});
  StepperOptions options = precise(Integrator::BDF2);
  options.residual = 1e-9;
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(clamped),
                          std::move(loads)),
                  options);
  stepper.step(1e-3);
  const double first = stepper.energy();
  double lowest = 0.0;
  for (int i = 0; i < 2000; ++i) {
    stepper.step(1e-3);
    lowest = std::min(lowest, stepper.rods().positions[10].z());
  }
  EXPECT_LT(lowest, -0.5) << "it has moved";
  EXPECT_NEAR(stepper.energy(), first, 0.01 * 2.0 * std::abs(lowest));
}

/// The work of a force in time is input: a step gains none beside it.
TEST(AppliedLoads, AStepOfImplicitEulerGainsNoEnergyBesideTheWorkOfLoads) {
  Rods rods = one_rod();
  Loads::Load load = force_at(10, Vector3d::Zero());
  load.force =
      Forces({{0.0, {0.0, 0.0, -1.0}}, {0.2, {0.0, 1.0, 1.0}}, {0.4, {0.0, 0.0, -1.0}}}, true);
  load.moment = Forces({{0.0, {0.0, 0.5, 0.0}}, {0.3, {0.0, -0.5, 0.5}}}, false);
  auto loads = std::make_unique<Loads>();
  loads->add(rods, load);
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})});
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(clamped),
                          std::move(loads)),
                  precise());
  double fastest = 0.0;
  for (int i = 0; i < 400; ++i) {
    stepper.step(0.005);
    ASSERT_LE(stepper.report().energy_gain, 1e-9) << "step " << i;
    fastest = std::max(fastest, stepper.rods().velocities[10].norm());
  }
  EXPECT_GT(fastest, 0.5);
}

TEST(AppliedLoads, ATorqueAtANodeIsSharedByItsEdges) {
  for (const std::uint32_t node : {0U, 4U, 10U}) {
    Rods rods = one_rod();
    const Twist twist(rods);
    Loads::Load load;
    load.node = node;
    load.torque = TimeTable<double>(0.3);
    Loads loads;
    loads.add(rods, load);
    loads.begin_step(rods, {0.0, 0.01});
    const Eigen::VectorXd gradient = derivatives_of(loads, rods, 0).gradient;
    const std::vector<std::uint32_t> edges = node == 0    ? std::vector<std::uint32_t>{0}
                                             : node == 10 ? std::vector<std::uint32_t>{9}
                                                          : std::vector<std::uint32_t>{3, 4};
    for (const std::uint32_t edge : edges) {
      EXPECT_NEAR(gradient[4 * edge + 3], -0.3 / static_cast<double>(edges.size()), 1e-15);
    }
  }
}

TEST(AppliedLoads, ChangeBetweenSteps) {
  Rods rods = one_rod();
  auto made = std::make_shared<Loads>();
  const std::uint32_t id = made->add(rods, force_at(0, {1.0, 0.0, 0.0}));
  Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>());
  all.push_back(made);
  Stepper stepper(rods, all, precise());
  stepper.step(0.01);
  made->set_force(id, {0.0, -2.0, 0.0});
  stepper.step(0.01);
  EXPECT_LE((momentum_under_loads(stepper.rods()) - Vector3d(0.01, -0.02, 0.0)).norm(), 1e-12);
}

TEST(AppliedLoads, RefusesWhatThereIsNot) {
  Rods rods = one_rod();
  const Rods before = rods;
  Loads loads;
  const auto error = [&](const Loads::Load& load) {
    return error_of([&] { loads.add(rods, load); });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Loads::Load load;
  load.rod = 1;
  EXPECT_EQ(error(load), "load on rod 1: there are 1 rods");
  EXPECT_EQ(error(force_at(11, Vector3d::UnitX())),
            "load on rod 0: it is at node 11, the rod has 11 nodes");
  EXPECT_EQ(error(force_at(0, {nan, 0.0, 0.0})), "load on rod 0: its force must be finite");
  EXPECT_EQ(error(force_along(0.5, 1.1, Vector3d::UnitX())),
            "load on rod 0: it is from 0.500000 to 1.100000 m, the rod from 0 to 1.000000 m");
  EXPECT_NE(error(force_along(0.5, 0.5, Vector3d::UnitX())), "no error");
  EXPECT_NE(error(force_along(-0.1, 0.5, Vector3d::UnitX())), "no error");
  load = Loads::Load{};
  load.mass = -1.0;
  EXPECT_EQ(error(load),
            "load on rod 0: the mass is -1.000000 kg, it must be at least 0 and finite");
  load = Loads::Load{};
  load.node = 5;
  load.moment = Forces(Vector3d::UnitX());
  EXPECT_EQ(error(load),
            "load on rod 0: a moment must be at an end of the rod: in between only a torque may "
            "act");
  load = Loads::Load{};
  load.torque = TimeTable<double>(1.0);
  EXPECT_EQ(error(load),
            "load on rod 0: a torque takes rods with twist: without it cross-sections turn freely");
  EXPECT_EQ(rods.masses, before.masses);
  EXPECT_EQ(error_of([] { Forces({}, false); }),
            "a table of times has no entry, it must have at least one");
  EXPECT_EQ(error_of([] {
              Forces({{0.0, {0, 0, 0}}, {0.0, {0, 0, 0}}}, false);
            }),
            "entry 1 of a table has the time 0.000000 s, times must be finite and rise from 0");
  EXPECT_NE(error_of([] { Forces({{0.1, {0, 0, 0}}}, false); }), "no error");
}

}  // namespace
}  // namespace fiber::test
