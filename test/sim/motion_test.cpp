// Motion against closed forms: frequencies, periods, and what the steps' length adds to them.

#include "validation/sim/motion.hpp"

#include <gtest/gtest.h>

#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double one_percent = 0.01;

TEST(Motion, ACantileverSwingsWithItsFrequencies) {
  struct Quoted {
    double low;
    double high;
    double frequency;
  };
  for (const Quoted& quoted : {Quoted{1.5, 2.5, 0.5596}, Quoted{4.0, 5.0, 3.507}}) {
    const double k = cantilever_root(quoted.low, quoted.high);
    const double exact = k * k / (2.0 * M_PI);
    EXPECT_NEAR(exact, quoted.frequency, 6e-4);
    EXPECT_NEAR(simulated_frequency(50, k), exact, one_percent * exact);
  }
}

TEST(Motion, ATwistedRodSwingsBackWithItsFrequency) {
  for (const double inertia : {1e-4, 0.01}) {
    const double exact = exact_torsion(inertia);
    EXPECT_NEAR(simulated_torsion(50, inertia), exact, one_percent * exact);
  }
}

TEST(Motion, ARigidPendulumSwingsWithTheEllipticIntegral) {
  for (const auto& [degrees, ratio] :
       std::vector<std::pair<double, double>>{{10, 1.00191}, {45, 1.03997}, {90, 1.18034}}) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * M_PI / 180.0;
    const double exact = exact_pendulum_ratio(angle);
    EXPECT_NEAR(exact, ratio, 6e-6);
    EXPECT_NEAR(simulated_pendulum_period(1, angle, 0.01) / point_pendulum_period(), exact,
                1e-3 * exact);
    EXPECT_NEAR(simulated_pendulum_period(50, angle, 0.01) / rod_pendulum_period(), exact,
                one_percent * exact);
    EXPECT_NEAR(simulated_plug_period(angle, 0.005) / rod_pendulum_period(), exact, 1e-3 * exact)
        << "a bar, not two masses";
  }
}

/// Half the step, a quarter of the error.
TEST(Motion, BDF2IsOfSecondOrderInTheStep) {
  // So short a step that its own error is far below.
  const double exact = simulated_pendulum_period(1, 1.0, 0.0005);
  double coarse = std::abs(simulated_pendulum_period(1, 1.0, 0.02) - exact);
  for (const double step : {0.01, 0.005}) {
    const double fine = std::abs(simulated_pendulum_period(1, 1.0, step) - exact);
    EXPECT_NEAR(coarse / fine, 4.0, 0.4) << "step " << step << ", error " << fine;
    coarse = fine;
  }
}

/// The speed that one edge has left after a second on its way back and forth along itself.
double damped_amplitude(double step) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 1), 0.01, {1.0, 0.0, 0.0, 2.0, 0.0});
  rods.positions[1].x() = 1.1;
  auto pinned = hold(rods, {pin(0, Vector3d::Zero())});
  Stepper stepper(rods, effects(std::make_unique<Stretch>(), std::move(pinned)), precise());
  const int steps = static_cast<int>(std::lround(1.0 / step));
  for (int i = 0; i < steps; ++i) {
    stepper.step(step);
  }
  return std::hypot(stepper.rods().positions[1].x() - 1.0, stepper.rods().velocities[1].x());
}

/// An oscillator of frequency 1 loses the part (1 + h²)^(-1/2) of its amplitude each step.
TEST(Motion, ImplicitEulerDampsInTheFirstOrderOfTheStep) {
  for (const double step : {0.1, 0.05, 0.01}) {
    const double exact = 0.1 * std::pow(1.0 + step * step, -0.5 / step);
    // The pin gives by 1e-6 of a stretch of 0.1.
    EXPECT_NEAR(damped_amplitude(step), exact, 1e-6) << step;
  }
  EXPECT_NEAR((0.1 - damped_amplitude(0.02)) / (0.1 - damped_amplitude(0.01)), 2.0, 0.05);
}

/// The two are equal to the last digits.
TEST(Motion, AFreeFallHasTheBiasOfItsIntegrator) {
  for (const double step : {0.1, 0.01}) {
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      const double exact = exact_fall(integrator, step, 50);
      for (const Vector3d& position : fallen_rod(integrator, step, 50).positions) {
        EXPECT_NEAR(position.z(), exact, 1e-11 * std::abs(exact));
      }
    }
  }
}

/// A hold is where its path says at the end of each step, however it gets there: but for what a
/// spring gives that is a thousand times as stiff as the rod.
TEST(Motion, AHeldNodeKeepsToItsPath) {
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    Rods rods;
    rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, {1e3, 0.1, 0.1, 1.0, 1e-4});
    const auto path = [](double time) {
      return Vector3d(0.1 * std::sin(5.0 * time), 0.1 - 0.1 * std::cos(7.0 * time), time * time);
    };
    Attachment::Hold follow = pin(0, Vector3d::Zero());
    follow.placement = [&](double time) {
      return Placement{path(time), Vector3d::Zero(), Vector3d::Zero()};
    };
    auto held = hold(rods, {follow});
    Stepper stepper(rods,
                    effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(held)),
                    precise(integrator));
    for (int i = 0; i < 100; ++i) {
      stepper.step(0.02);
      ASSERT_LE((stepper.rods().positions[0] - path(stepper.time())).norm(), 1e-5) << "step " << i;
    }
  }
}

}  // namespace
}  // namespace fiber::test
