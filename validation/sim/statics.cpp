#include "validation/sim/statics.hpp"

#include <cmath>

#include "fiber_proximity/sim/loads.hpp"
#include "validation/sim/rod_scene.hpp"
#include "validation/sim/root.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

const Vector3d down(0.0, 0.0, -1.0);

}  // namespace

CantileverTip simulated_tip(int segments, double load, double spread) {
  Rods rods;
  // Where the rod weighs nothing, its masses must be there all the same: far less than the load.
  const double mass = spread > 0.0 ? spread : 1e-9;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, {1e7, 1.0, 1.0, mass, 1e-6});
  Loads::Load end_force;
  end_force.node = rods.node_count(0) - 1;
  end_force.force = TimeTable<Vector3d>(load * down);
  auto loads = std::make_unique<Loads>();
  loads->add(rods, end_force);
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})});
  Stepper stepper(rods,
                  effects(std::make_unique<Gravity>(down), std::make_unique<Stretch>(),
                          std::make_unique<Bend>(), std::move(clamped), std::move(loads)),
                  precise());
  settle(stepper);
  const Vector3d& tip = stepper.rods().positions.back();
  return {-tip.z(), tip.x()};
}

HangingChain exact_catenary(double length) {
  const double u = root_between([&](double x) { return std::sinh(x) / x - length; }, 1e-3, 10.0);
  return {(std::cosh(u) - 1.0) / (2.0 * u), 1.0 / (2.0 * u)};
}

HangingChain simulated_catenary(double length, int segments) {
  const double depth = 0.5 * std::sqrt(length * length - 1.0);
  std::vector<Vector3d> points = straight({0, 0, 0}, {0.5, 0, -depth}, segments / 2);
  points.pop_back();
  for (const Vector3d& point : straight({0.5, 0, -depth}, {1, 0, 0}, segments / 2)) {
    points.push_back(point);
  }
  Rods rods;
  const double stiffness = 1e6;
  rods.add(points, 0.001, {stiffness, 0.0, 0.0, 1.0, 0.0});
  auto pinned = hold(rods, {pin(0, points.front()), pin(segments, points.back())});
  Stepper stepper(
      rods,
      effects(std::make_unique<Gravity>(down), std::make_unique<Stretch>(), std::move(pinned)),
      precise());
  settle(stepper);
  const std::vector<Vector3d>& positions = stepper.rods().positions;
  const Vector3d edge = positions[1] - positions[0];
  const double tension = stiffness * (edge.norm() / rods.rest_lengths[0] - 1.0);
  return {-positions[segments / 2].z(), tension * edge.normalized().x()};
}

}  // namespace fiber
