#include "validation/sim/motion.hpp"

#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "validation/sim/rod_scene.hpp"
#include "validation/sim/root.hpp"

namespace fiber {

using Eigen::Vector3d;

const Vector3d pendulum_gravity(0.0, 0.0, -9.81);

namespace {

const Vector3d& gravity = pendulum_gravity;

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

}  // namespace

double cantilever_root(double low, double high) {
  return root_between([](double x) { return 1.0 + std::cos(x) * std::cosh(x); }, low, high);
}

double simulated_frequency(int segments, double root) {
  const double exact = root * root / (2.0 * M_PI);
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, {1e5, 1.0, 1.0, 1.0, 1e-4});
  for (int i = 0; i <= segments; ++i) {
    rods.velocities[i].z() = 1e-3 * mode_shape(root, static_cast<double>(i) / segments);
  }
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})});
  Stepper stepper(
      rods, effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(clamped)),
      precise(Integrator::BDF2));
  Zeros zeros;
  for (int i = 0; i < 400; ++i) {
    stepper.step(0.01 / exact);
    zeros.add(stepper.time(), stepper.rods().positions.back().z());
  }
  return 1.0 / zeros.period();
}

// A quarter of a wave lies on the rod.
double exact_torsion(double inertia) { return 0.25 / std::sqrt(inertia); }

double simulated_torsion(int segments, double inertia) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, {1e5, 1.0, 1.0, 1.0, inertia});
  auto twist = std::make_unique<Twist>(rods);
  for (int i = 0; i < segments; ++i) {
    rods.angles[i] = 0.1 * std::sin(0.5 * M_PI * (i + 0.5) / segments);
  }
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), rods.directors[0]})});
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::move(clamped)),
                  precise(Integrator::BDF2));
  Zeros zeros;
  for (int i = 0; i < 400; ++i) {
    stepper.step(0.01 / exact_torsion(inertia));
    zeros.add(stepper.time(), stepper.rods().angles[segments - 1]);
  }
  return 1.0 / zeros.period();
}

double exact_pendulum_ratio(double amplitude) {
  return 2.0 / M_PI * std::comp_ellint_1(std::sin(0.5 * amplitude));
}

double point_pendulum_period() { return 2.0 * M_PI * std::sqrt(1.0 / gravity.norm()); }

double rod_pendulum_period() { return std::sqrt(2.0 / 3.0) * point_pendulum_period(); }

double period_of_swing(const Rods& rods, Effects all, double step) {
  Stepper stepper(rods, std::move(all), precise(Integrator::BDF2));
  Zeros zeros;
  while (zeros.count() < 5) {
    stepper.step(step);
    zeros.add(stepper.time(), stepper.rods().positions.back().x());
  }
  return zeros.period();
}

namespace {

constexpr RodSection pendulum_section{1e5, 1e3, 1.0, 1.0, 1e-4};

Rods pendulum(int segments, double angle) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {std::sin(angle), 0, -std::cos(angle)}, segments), 0.01,
           pendulum_section);
  return rods;
}

double period_of(Rods rods, double step) {
  auto pinned = hold(rods, {pin(0, Vector3d::Zero())});
  return period_of_swing(rods,
                         effects(std::make_unique<Gravity>(gravity), std::make_unique<Stretch>(),
                                 std::make_unique<Bend>(), std::move(pinned)),
                         step);
}

}  // namespace

double simulated_pendulum_period(int segments, double angle, double step) {
  return period_of(pendulum(segments, angle), step);
}

double simulated_plug_period(double angle, double step) {
  Rods rods = pendulum(1, angle);
  rods.set_sections(0, {{{0.0, rods.rest_lengths[0]}, pendulum_section, std::nullopt, true}});
  return period_of(std::move(rods), step);
}

Rods fallen_rod(Integrator integrator, double step, int steps) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, {1e3, 0.1, 0.1, 1.0, 1e-4});
  Stepper stepper(rods,
                  effects(std::make_unique<Gravity>(gravity), std::make_unique<Stretch>(),
                          std::make_unique<Bend>()),
                  precise(integrator));
  for (int i = 0; i < steps; ++i) {
    stepper.step(step);
  }
  return stepper.rods();
}

double exact_fall(Integrator integrator, double step, int steps) {
  const double time = steps * step;
  const double bias =
      integrator == Integrator::IMPLICIT_EULER ? 0.5 * gravity.norm() * time * step : 0.0;
  return -0.5 * gravity.norm() * time * time - bias;
}

}  // namespace fiber
