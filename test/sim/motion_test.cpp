// Motion against closed forms: frequencies, periods, and what the steps' length adds to them.

#include <gtest/gtest.h>

#include "sim/elastica.hpp"
#include "sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double one_percent = 0.01;
const Vector3d gravity(0.0, 0.0, -9.81);

/// Crossings of zero by a number that swings, to between the steps.
class Zeros {
 public:
  void add(double time, double value) {
    if (has_last_ && (value > 0.0) != (last_value_ > 0.0)) {
      const double part = last_value_ / (last_value_ - value);
      times_.push_back(last_time_ + part * (time - last_time_));
    }
    has_last_ = true;
    last_time_ = time;
    last_value_ = value;
  }

  /// Mean time between every other one.
  double period() const {
    return 2.0 * (times_.back() - times_.front()) / static_cast<double>(times_.size() - 1);
  }

  std::size_t count() const { return times_.size(); }

 private:
  std::vector<double> times_;
  bool has_last_ = false;
  double last_time_ = 0.0;
  double last_value_ = 0.0;
};

/// How a cantilever swings in a mode with the root k of 1 + cos k cosh k.
double mode_shape(double k, double s) {
  const double ratio = (std::cos(k) + std::cosh(k)) / (std::sin(k) + std::sinh(k));
  return std::cosh(k * s) - std::cos(k * s) - ratio * (std::sinh(k * s) - std::sin(k * s));
}

TEST(Motion, ACantileverSwingsWithItsFrequencies) {
  struct Quoted {
    double low;
    double high;
    double frequency;
  };
  for (const Quoted& quoted : {Quoted{1.5, 2.5, 0.5596}, Quoted{4.0, 5.0, 3.507}}) {
    const double k = root_between([](double x) { return 1.0 + std::cos(x) * std::cosh(x); },
                                  quoted.low, quoted.high);
    const double exact = k * k / (2.0 * M_PI);
    EXPECT_NEAR(exact, quoted.frequency, 6e-4);
    Rods rods;
    rods.add(straight({0, 0, 0}, {1, 0, 0}, 50), 0.01, {1e5, 1.0, 1.0, 1.0, 1e-4});
    for (int i = 0; i <= 50; ++i) {
      rods.velocities[i].z() = 1e-3 * mode_shape(k, i / 50.0);
    }
    auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})});
    Stepper stepper(
        rods, effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(clamped)),
        precise(Integrator::IMPLICIT_MIDPOINT));
    Zeros zeros;
    for (int i = 0; i < 400; ++i) {
      stepper.step(0.01 / exact);
      zeros.add(stepper.time(), stepper.rods().positions.back().z());
    }
    EXPECT_NEAR(1.0 / zeros.period(), exact, one_percent * exact);
  }
}

/// Of a rod of length 1 that is let go at an angle from the vertical.
double pendulum_period(int segments, double angle, double step) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {std::sin(angle), 0, -std::cos(angle)}, segments), 0.01,
           {1e5, 1e3, 1.0, 1.0, 1e-4});
  auto pinned = hold(rods, {pin(0, Vector3d::Zero())});
  Stepper stepper(rods,
                  effects(std::make_unique<Gravity>(gravity), std::make_unique<Stretch>(),
                          std::make_unique<Bend>(), std::move(pinned)),
                  precise(Integrator::IMPLICIT_MIDPOINT));
  Zeros zeros;
  while (zeros.count() < 5) {
    stepper.step(step);
    zeros.add(stepper.time(), stepper.rods().positions.back().x());
  }
  return zeros.period();
}

TEST(Motion, ARigidPendulumSwingsWithTheEllipticIntegral) {
  for (const auto& [degrees, ratio] :
       std::vector<std::pair<double, double>>{{10, 1.00191}, {45, 1.03997}, {90, 1.18034}}) {
    SCOPED_TRACE(degrees);
    const double angle = degrees * M_PI / 180.0;
    const double exact = 2.0 / M_PI * std::comp_ellint_1(std::sin(0.5 * angle));
    EXPECT_NEAR(exact, ratio, 6e-6);
    // One edge has its mass at its ends, many have it all along.
    const double of_point = 2.0 * M_PI * std::sqrt(1.0 / gravity.norm());
    const double of_rod = 2.0 * M_PI * std::sqrt(2.0 / 3.0 / gravity.norm());
    EXPECT_NEAR(pendulum_period(1, angle, 0.01) / of_point, exact, 1e-3 * exact);
    EXPECT_NEAR(pendulum_period(50, angle, 0.01) / of_rod, exact, one_percent * exact);
  }
}

/// Half the step, a quarter of the error.
TEST(Motion, ImplicitMidpointIsOfSecondOrderInTheStep) {
  // So short a step that its own error is far below.
  const double exact = pendulum_period(1, 1.0, 0.0005);
  double coarse = std::abs(pendulum_period(1, 1.0, 0.04) - exact);
  for (const double step : {0.02, 0.01}) {
    const double fine = std::abs(pendulum_period(1, 1.0, step) - exact);
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
    EXPECT_NEAR(damped_amplitude(step), exact, 1e-9) << step;
  }
  EXPECT_NEAR((0.1 - damped_amplitude(0.02)) / (0.1 - damped_amplitude(0.01)), 2.0, 0.05);
}

/// Implicit Euler is ahead by ½ g t h, to the last digits; implicit midpoint is exact.
TEST(Motion, AFreeFallHasTheBiasOfItsIntegrator) {
  for (const double step : {0.1, 0.01}) {
    for (const Integrator integrator :
         {Integrator::IMPLICIT_EULER, Integrator::IMPLICIT_MIDPOINT}) {
      Rods rods;
      rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, {1e3, 0.1, 0.1, 1.0, 1e-4});
      Stepper stepper(rods,
                      effects(std::make_unique<Gravity>(gravity), std::make_unique<Stretch>(),
                              std::make_unique<Bend>()),
                      precise(integrator));
      for (int i = 0; i < 50; ++i) {
        stepper.step(step);
      }
      const double time = 50 * step;
      const double bias =
          integrator == Integrator::IMPLICIT_EULER ? 0.5 * gravity.norm() * time * step : 0.0;
      const double exact = -0.5 * gravity.norm() * time * time - bias;
      for (const Vector3d& position : stepper.rods().positions) {
        EXPECT_NEAR(position.z(), exact, 1e-11 * std::abs(exact));
      }
    }
  }
}

/// A hold is where its path says at the end of each step, however it gets there.
TEST(Motion, AHeldNodeKeepsToItsPath) {
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::IMPLICIT_MIDPOINT}) {
    Rods rods;
    rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, {1e3, 0.1, 0.1, 1.0, 1e-4});
    const auto path = [](double time) {
      return Vector3d(0.1 * std::sin(5.0 * time), 0.1 * std::cos(7.0 * time), 0.1 + time * time);
    };
    auto held = hold(rods, {{0, 0, Attachment::Kind::PIN, [&](double time) {
                               return Placement{path(time), Vector3d::Zero(), Vector3d::Zero()};
                             }}});
    Stepper stepper(rods,
                    effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(held)),
                    precise(integrator));
    for (int i = 0; i < 100; ++i) {
      stepper.step(0.02);
      ASSERT_EQ(stepper.rods().positions[0], path(stepper.time())) << "step " << i;
    }
  }
}

}  // namespace
}  // namespace fiber::test
