// Rods that bend more easily to one side than to another.

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "fiber_proximity/sim/effects.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/error_of.hpp"
#include "validation/sim/rod_scene.hpp"
#include "validation/sim/strips.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Whatever side it is: along it so many times as stiff, across it as it was, each for itself.
TEST(AnisotropicBend, ACantileverGivesWayByItsTwoStiffnesses) {
  for (const double degrees : {0.0, 35.0, 90.0}) {
    SCOPED_TRACE(degrees);
    const StripDeflection found = simulated_strip(degrees * M_PI / 180.0);
    EXPECT_NEAR(found.soft, 1.0, 0.005);
    EXPECT_NEAR(found.stiff, 1.0 / strip_ratio, 0.005 / strip_ratio);
  }
}

/// In the plane of the stiff side it is a round rod of that stiffness, however far it bends.
TEST(AnisotropicBend, BendsFarAsARoundRodOfThatStiffness) {
  RodSection round = strip(1.0);
  round.bending_stiffness *= strip_ratio;
  const Vector3d force(0.0, 0.0, -5.0 * round.bending_stiffness);
  const Vector3d expected = settled_tip(strip_scene(strip_of(round), Vector3d::Zero(), force));
  ASSERT_LT(expected.z(), -0.6) << "it bends far";
  const Vector3d tip =
      settled_tip(strip_scene(strip_of(strip(strip_ratio)), Vector3d::UnitZ(), force));
  EXPECT_LE((tip - expected).norm(), 0.005);
}

/// Let go, it swings to its stiff side as a round rod of that stiffness does, damped as that is.
TEST(AnisotropicBend, IsDampedAsARoundRodOfThatStiffness) {
  RodSection round = strip(1.0);
  round.bending_stiffness *= strip_ratio;
  const auto tips = [](const RodSection& section, const Vector3d& side, double relaxation_time) {
    StripScene scene = strip_scene(strip_of(section), side, Vector3d::Zero());
    const auto damping = std::make_shared<Damping>(relaxation_time);
    scene.effects.push_back(damping);
    scene.effects.push_back(std::make_shared<AnisotropicDamping>(damping));
    for (std::uint32_t i = 1; i <= strip_edges; ++i) {
      const double along = static_cast<double>(i) / strip_edges;
      scene.rods.positions[i].z() += 0.1 * along * along;
    }
    StepperOptions options = precise();
    options.integrator = Integrator::BDF2;
    Stepper stepper(scene.rods, std::move(scene.effects), options);
    std::vector<double> heights;
    for (int i = 0; i < 150; ++i) {
      stepper.step(0.01);
      heights.push_back(stepper.rods().positions[strip_edges].z());
    }
    return heights;
  };
  const std::vector<double> expected = tips(round, Vector3d::Zero(), 0.02);
  const std::vector<double> undamped = tips(round, Vector3d::Zero(), 0.0);
  const std::vector<double> found = tips(strip(strip_ratio), Vector3d::UnitZ(), 0.02);
  double largest = 0.0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_NEAR(found[i], expected[i], 0.002) << i;
    largest = std::max(largest, std::abs(expected[i] - undamped[i]));
  }
  EXPECT_GT(largest, 0.02) << "damping can be seen";
}

/// Bent to both sides and twisted, then let go: implicit Euler gains no energy in any step, BDF2
/// none in the end and loses less, and both swing.
TEST(AnisotropicBend, ASwingingStripGainsNoEnergy) {
  double left = 0.0;  // of the energy, by implicit Euler
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    SCOPED_TRACE(static_cast<int>(integrator));
    StripScene scene =
        strip_scene(strip_of(strip(strip_ratio)), Vector3d(0.0, 0.6, 0.8), Vector3d::Zero());
    for (std::uint32_t i = 1; i <= strip_edges; ++i) {
      const double along = static_cast<double>(i) / strip_edges;
      scene.rods.positions[i] = scene.rods.positions[i - 1] +
                                Vector3d(1.0, 0.15 * along, 0.5 * along).normalized() / strip_edges;
      scene.rods.angles[i - 1] = 0.4 * along;
    }
    StepperOptions options = precise();
    options.integrator = integrator;
    Stepper stepper(scene.rods, std::move(scene.effects), options);
    stepper.step(0.004);
    const double first = stepper.energy();
    double lowest = 1.0;
    for (int i = 0; i < 400; ++i) {
      const double before = stepper.energy();
      stepper.step(0.004);
      if (integrator == Integrator::IMPLICIT_EULER) {
        ASSERT_LE(stepper.energy(), before + 1e-6 * first) << i;
      }
      lowest = std::min(lowest, stepper.rods().positions[strip_edges].z());
    }
    const double share = stepper.energy() / first;
    EXPECT_GT(share, left);
    EXPECT_LT(share, 1.001);
    left = share;
    EXPECT_LT(lowest, -0.05) << "it swings";
  }
}

/// By the integral of the squared lever over each part, with a step inside of an edge.
TEST(AnisotropicBend, OfPartsGivesWayInSeries) {
  constexpr double force = 1e-3;
  constexpr double step = 0.413;
  Rods rods = strip_of(strip(strip_ratio));
  rods.set_sections(0, {{{step, 1.0}, strip(1.0)}});
  const Vector3d tip =
      settled_tip(strip_scene(std::move(rods), Vector3d::UnitZ(), force * Vector3d(0.0, 1.0, 1.0)));
  const double rest = std::pow(1.0 - step, 3);
  const double expected = force / 3.0 * ((1.0 - rest) / strip_ratio + rest);
  EXPECT_NEAR(tip.z(), expected, 0.005 * expected);
  EXPECT_NEAR(tip.y(), force / 3.0, 0.005 * force / 3.0);
}

/// A strip on edge gives way sideways when its clamp is turned: cross-sections carry the side
/// along.
TEST(AnisotropicBend, TheSideTurnsWithTheClamp) {
  constexpr double force = 1e-3;
  StripScene turned =
      strip_scene(strip_of(strip(strip_ratio)), Vector3d::UnitZ(), {0.0, 0.0, -force});
  turned.effects.pop_back();
  const Vector3d director = turned.rods.directors[0];
  turned.effects.push_back(
      hold(turned.rods, {{0, 0, Attachment::Kind::CLAMP, [director](double time) {
                            const double angle = std::min(1.0, time) * 0.5 * M_PI;
                            const Eigen::AngleAxisd turn(angle, Vector3d::UnitX());
                            return Placement{Vector3d::Zero(), Vector3d::UnitX(), turn * director};
                          }}}));
  Stepper stepper(turned.rods, std::move(turned.effects), precise());
  for (int i = 0; i < 50; ++i) {
    stepper.step(0.02);
  }
  settle(stepper);
  const double sag = -stepper.rods().positions[strip_edges].z();
  EXPECT_NEAR(sag, force / 3.0, 0.005 * force / 3.0);
}

TEST(AnisotropicBend, AShapeThatIsNaturalIsAtRest) {
  SCOPED_TRACE(seed_message());
  Random random(52);
  for (int round = 0; round < 20; ++round) {
    Rods rods;
    rods.add(random_chain(random, 8, 0.1), 0.01, strip(strip_ratio));
    const Twist twist(rods);
    rods.set_stiff_side(0, random.direction());
    AnisotropicBend bend;
    bend.begin_step(rods, {0.0, 0.01});
    const double straight_at_rest = energy_of(bend, rods);
    set_natural_shape(rods);
    bend.begin_step(rods, {0.0, 0.01});
    EXPECT_GT(straight_at_rest, 0.1);
    EXPECT_LE(energy_of(bend, rods), 1e-20 * straight_at_rest);
  }
}

TEST(AnisotropicBend, DerivativesAreThoseOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(51);
  for (int round = 0; round < 30; ++round) {
    Rods rods;
    RodSection section = random_section(random);
    section.bending_ratio = random.uniform(1.5, 10.0);
    rods.add(random_chain(random, random.integer(3, 7), 0.3), 0.01, section);
    Twist twist(rods);
    rods.set_stiff_side(0, random.direction());
    if (round % 2 == 0) {
      rods.natural_curvature_vectors.assign(rods.positions.size(), {1.0, -2.0});
    }
    AnisotropicBend bend;
    AnisotropicDamping damping(std::make_shared<Damping>(100.0));
    Attachment attachment;
    const Vector3d tangent = (rods.positions[1] - rods.positions[0]).normalized();
    attachment.add(rods, clamp(0, {rods.positions[0], tangent, rods.directors[0]}));
    for (Effect* const effect : std::initializer_list<Effect*>{&bend, &damping, &attachment}) {
      effect->begin_step(rods, {0.0, 1e3});  // so long that the hold is soft
    }
    displace(rods, random, 0.03, 0.5);
    for (const Effect* const effect :
         std::initializer_list<Effect*>{&bend, &damping, &attachment}) {
      const Derivatives found = derivatives_of(*effect, rods, 0);
      const Eigen::VectorXd expected = gradient_by_differences(*effect, rods, 0, 1e-6);
      ASSERT_LE((found.gradient - expected).norm(), 1e-5 * (1.0 + expected.norm()))
          << "round " << round;
      const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(found.hessian);
      ASSERT_GE(eigen.eigenvalues().minCoeff(), -1e-9 * found.hessian.norm());
    }
    expect_same_side_by_side(bend, rods);
    expect_same_side_by_side(damping, rods);
  }
}

TEST(AnisotropicBend, SidesThatCannotBeAreRefused) {
  Rods rods = strip_of(strip(strip_ratio));
  const auto error = [&](const Vector3d& side) {
    return error_of([&] { rods.set_stiff_side(0, side); });
  };
  EXPECT_EQ(error(Vector3d::UnitZ()),
            "rod 0: stiff side: cross-sections have no side without twist");
  const Twist twist(rods);
  EXPECT_EQ(error(Vector3d::UnitX()),
            "rod 0: stiff side: the side must be finite and not along the first edge of rod 0");
  EXPECT_EQ(error(Vector3d(0.0, NAN, 1.0)),
            "rod 0: stiff side: the side must be finite and not along the first edge of rod 0");
  EXPECT_TRUE(rods.stiff_sides.empty());
  EXPECT_EQ(error_of([&] {
              Rods others;
              others.add(straight({0, 0, 0}, {1, 0, 0}, 2), 0.01, strip(0.5));
            }),
            "bending_ratio is 0.500000, it must be at least 1 and finite");
}

}  // namespace
}  // namespace fiber::test
