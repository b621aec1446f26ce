#include "validation/sim/impacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "validation/sim/moving_scene.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

constexpr double touching_height = 1.05 * impact_radius;  // where the barrier begins [m]

double mean_height(const Rods& rods) {
  double sum = 0.0;
  for (const Vector3d& position : rods.positions) {
    sum += position.z();
  }
  return sum / static_cast<double>(rods.positions.size()) - touching_height;
}

/// A level rod of 20 cm along y, so far above where the barrier of a table at z = 0 begins [m].
Rods level_rod(const std::string& material, double above) {
  Rods rods;
  const double z = above + touching_height;
  rods.add(straight({0.0, 0.0, z}, {0.0, 0.2, z}, 10), impact_radius,
           solid_round_section(material_preset(material), impact_radius));
  return rods;
}

}  // namespace

std::unique_ptr<Contacts> table_with(double restitution, std::shared_ptr<Friction> friction,
                                     const Vector3d& velocity) {
  EnvironmentContact::Options options;
  options.restitution = restitution;
  std::vector<std::unique_ptr<ContactSource>> sources;
  if (!velocity.isZero()) {
    const auto motions = std::make_shared<ObstacleMotions>(
        std::vector<MovingObstacle>{going(HalfSpaceShape{}, Vector3d::Zero(), velocity)}, 0);
    sources.push_back(std::make_unique<MovingObstacleContact>(motions, options));
    return std::make_unique<Contacts>(std::move(sources), std::move(friction), motions);
  }
  sources.push_back(
      std::make_unique<EnvironmentContact>(environment_of(HalfSpaceShape{}), options));
  return std::make_unique<Contacts>(std::move(sources), std::move(friction));
}

double Drop::fall() const { return std::sqrt(2.0 * height / standard_gravity); }

double simulated_rebound(const Drop& drop) {
  StepperOptions options;
  options.integrator = drop.integrator;
  Rods rods = level_rod(drop.material, drop.height);
  std::fill(rods.velocities.begin(), rods.velocities.end(), drop.velocity);
  Stepper stepper(rods, elastic(standard_gravity), options,
                  table_with(drop.restitution, nullptr, drop.velocity));
  double highest = -1.0;
  bool has_hit = false;
  const double end = drop.fall() * (1.1 + std::max(0.3, 1.2 * drop.restitution));
  for (double time = 0.0; time < end; time += drop.step) {
    stepper.step(drop.step);
    has_hit |= stepper.report().impacts > 0;
    if (has_hit) {
      highest = std::max(highest, mean_height(stepper.rods()) - stepper.time() * drop.velocity.z());
    }
  }
  return highest;
}

Deflection simulated_deflection(Integrator integrator, double step, double restitution,
                                double friction, const std::string& material) {
  Rods rods = level_rod(material, 0.02);
  std::fill(rods.velocities.begin(), rods.velocities.end(), Vector3d(0.0, 2.0, -2.0));
  const Vector3d before = momentum_of(rods);
  StepperOptions options;
  options.integrator = integrator;
  Stepper stepper(rods, elastic(), options,
                  table_with(restitution, std::make_shared<Friction>(Friction::Options{friction})));
  Deflection deflection;
  deflection.approach = -before.z();
  for (double time = 0.0; time < 0.05; time += step) {
    stepper.step(step);
    deflection.has_hit |= stepper.report().impacts > 0;
  }
  const Vector3d impulse = momentum_of(stepper.rods()) - before;
  deflection.along = -impulse.y();
  deflection.across = impulse.z();
  return deflection;
}

Push simulated_push(Integrator integrator) {
  constexpr double radius = 0.002;
  constexpr double friction = 0.3;
  constexpr double step = 1.0 / 240.0;
  Rods rods;
  rods.add(straight({0.0, -0.2, 0.0}, {0.0, 0.2, 0.0}, 20), radius, rubber(radius));
  StepperOptions options;
  options.integrator = integrator;
  options.residual = 1e-7;
  options.max_iterations = 1000;
  options.threads = 1;
  Stepper stepper(rods, elastic(), options,
                  contacts_with_moving({going(BoxShape{Vector3d(0.1, 0.3, 0.1)}, {-0.06, 0.03, 0.0},
                                              {2.0, 0.5, 0.3})},
                                       friction));
  double largest_change = 0.0;
  Push push;
  push.impulse.setZero();
  for (int i = 0; i < 48; ++i) {
    const Vector3d before = momentum_of(stepper.rods());
    stepper.step(step);
    const Vector3d change = momentum_of(stepper.rods()) - before;
    const Vector3d felt = step * stepper.forces().obstacles.at(0).force;
    largest_change = std::max(largest_change, change.norm());
    push.impulse -= felt;
    if (largest_change > 0.0 &&
        (integrator == Integrator::IMPLICIT_EULER || stepper.report().is_first_order)) {
      push.largest_error = std::max(push.largest_error, (change + felt).norm() / largest_change);
    }
  }
  push.momentum = momentum_of(stepper.rods());
  return push;
}

}  // namespace fiber
