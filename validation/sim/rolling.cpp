#include "validation/sim/rolling.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "validation/sim/contact_scenes.hpp"

namespace fiber {

using Eigen::Vector3d;

RodOnSlope::RodOnSlope(double angle, double radius, double friction, Integrator integrator) {
  Rods rods;
  rods.add(straight({0.0, 0.0, radius}, {0.0, 40.0 * radius, radius}, 8), radius, rubber(radius));
  Effects effects = elastic();
  effects.push_back(std::make_unique<Gravity>(standard_gravity *
                                              Vector3d(std::sin(angle), 0.0, -std::cos(angle))));
  effects.push_back(std::make_unique<Twist>(rods));
  StepperOptions options;
  options.integrator = integrator;
  stepper_ = std::make_unique<Stepper>(
      rods, std::move(effects), options,
      contacts_with(environment_of(HalfSpaceShape{Vector3d::UnitZ(), 0.0}), friction));
}

void RodOnSlope::run(double time) const {
  constexpr double step = 1.0 / 240.0;
  for (int i = 0; i < std::lround(time / step); ++i) {
    stepper_->step(step);
  }
}

double RodOnSlope::speed() const {
  double mass = 0.0;
  for (const double each : stepper_->rods().masses) {
    mass += each;
  }
  return momentum_of(stepper_->rods()).x() / mass;
}

double RodOnSlope::mean_spin() const {
  const std::vector<double>& spins = stepper_->rods().spins;
  double sum = 0.0;
  for (std::size_t edge = 0; edge + 1 < spins.size(); ++edge) {
    sum += spins[edge];
  }
  return sum / static_cast<double>(spins.size() - 1);
}

}  // namespace fiber
