// Joints keep momentum and energy as rods do, to the last bit for any number of threads; and the
// derivatives of welds.

#include <gtest/gtest.h>

#include "src/sim/joint/make_welds.hpp"
#include "test/sim/joint_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

Vector3d angular_momentum_of(const Rods& rods) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    sum += rods.masses[i] * rods.positions[i].cross(rods.velocities[i]);
  }
  return sum;
}

Effects free_of_gravity(Rods& rods, bool has_twist) {
  Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>());
  if (has_twist) {
    all.push_back(std::make_unique<Twist>(rods));
  }
  return all;
}

TEST(Joints, KeepMomentum) {
  for (const Joints::Kind kind : {Joints::Kind::BALL, Joints::Kind::WELD}) {
    for (const bool has_twist : {false, true}) {
      Rods rods = branches();
      Effects all = free_of_gravity(rods, has_twist);
      auto joints = joints_of({});
      joints->add(rods, branching(kind));
      throw_rods(rods);
      for (double& spin : rods.spins) {
        spin = 0.0;
      }
      joints->unite(rods);
      const Vector3d momentum = momentum_of(rods);
      const Vector3d angular = angular_momentum_of(rods);
      Stepper stepper(rods, std::move(all), precise(Integrator::BDF2), nullptr, std::move(joints));
      for (int i = 0; i < 400; ++i) {
        stepper.step(0.0005);
        ASSERT_LE((momentum_of(stepper.rods()) - momentum).norm(), 1e-12);
      }
      EXPECT_LE((angular_momentum_of(stepper.rods()) - angular).norm(), 1e-3 * angular.norm());
      EXPECT_EQ(stepper.rods().positions[0], stepper.rods().positions[rods.first(2)]);
    }
  }
}

/// As ImplicitEulerGainsNoEnergy, which is of rods that are not joined.
TEST(Joints, ImplicitEulerGainsNoEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(11);
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    Rods rods = branches(random.uniform(0.3, 1.0));
    Effects all = free_of_gravity(rods, round % 4 > 1);
    const double relaxation = round % 3 == 0 ? 0.02 : 0.0;
    auto joints =
        std::make_unique<Joints>(Joints::Options{true, std::make_shared<Damping>(relaxation)});
    joints->add(rods, branching(round % 2 == 0 ? Joints::Kind::BALL : Joints::Kind::WELD));
    give_velocities(rods, random, 1.0);
    Stepper stepper(rods, std::move(all), precise(), nullptr, std::move(joints));
    const double step = std::pow(10.0, random.uniform(-3.0, -2.0));
    stepper.step(step);
    double before = stepper.energy();
    const double first = before;
    for (int i = 0; i < 100; ++i) {
      stepper.step(step);
      const double after = stepper.energy();
      ASSERT_LE(after, before + 1e-9 * first) << i;
      ASSERT_NEAR(stepper.report().energy_gain, after - before, 1e-9 * first);
      before = after;
    }
  }
}

/// Energies and their derivatives of a random weld, away from its rest.
TEST(Joints, DerivativesOfWelds) {
  SCOPED_TRACE(seed_message());
  Random random(12);
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    Rods rods = rods_of_equal_sizes(random, 2, 3, 0.3);
    if (round % 2 == 0) {
      const Twist twist(rods);
    }
    Weld weld = make_weld(rods, {{{0, 1, 2, 1.0}, {1, 3, 3, 1.0}}}, WeldPath::SHORTER);
    weld.bending = random.uniform(0.5, 2.0);
    weld.twisting = random.uniform(0.5, 2.0);
    if (round % 4 == 0) {
      const double angle = random.uniform(0.0, 3.0);
      weld.stiff_side = {random.uniform(0.5, 2.0), {std::cos(angle), std::sin(angle)}};
    }
    ASSERT_NEAR(WeldStrain(weld, rods, rods).energy(), 0.0, 1e-15);
    weld.damping_share = round % 3 == 0 ? 0.7 : 0.0;
    weld.earlier_strain = WeldStrain(weld, rods, rods).strain();
    displace(rods, random, 0.05, 0.4);
    const WeldStrain strain(weld, rods, rods);
    const WeldStrain::Derivatives found = strain.derivatives();
    const auto energy = [&] { return WeldStrain(weld, rods, rods).energy(); };
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t edge = weld.edges[side].edge;
      const bool has_twist = !rods.angles.empty();
      for (Eigen::Index i = 0; i < (has_twist ? 7 : 6); ++i) {
        const Eigen::Index node = i / (has_twist ? 4 : 3);
        const Eigen::Index part = i % (has_twist ? 4 : 3);
        double& x = part == 3 ? rods.angles[edge] : rods.positions[edge + node][part];
        const double middle = x;
        constexpr double difference = 1e-6;
        x = middle + difference;
        const double after = energy();
        x = middle - difference;
        const double before = energy();
        x = middle;
        EXPECT_NEAR(found.gradient[side][i], (after - before) / (2.0 * difference), 1e-7)
            << side << " " << i;
      }
    }
  }
}

TEST(Joints, DoNotDependOnThreads) {
  const auto run = [](std::uint32_t threads) {
    Rods rods;
    for (int i = 0; i < 12; ++i) {
      rods.add(straight({0.1 * i, 0.0, 0.0}, {0.1 * i, 0.3, 0.01 * i}, 9), 0.004, section_of(0.01));
      rods.add(straight({0.1 * i, 0.3, 0.01 * i}, {0.1 * i, 0.5, 0.2}, 5), 0.004, section_of(0.01));
    }
    auto joints = joints_of({});
    for (std::uint32_t i = 0; i < 12; ++i) {
      joints->add(rods, {i % 2 == 0 ? Joints::Kind::WELD : Joints::Kind::BALL,
                         {{2 * i, 9}, {2 * i + 1, 0}}});
    }
    throw_rods(rods);
    Effects all = effects_of(rods, {});
    StepperOptions options;
    options.threads = threads;
    Stepper stepper(rods, std::move(all), options, nullptr, std::move(joints));
    for (int i = 0; i < 20; ++i) {
      stepper.step(0.004);
    }
    return stepper.rods().positions;
  };
  EXPECT_EQ(run(1), run(4));
}

}  // namespace
}  // namespace fiber::test
