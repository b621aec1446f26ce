#include "validation/sim/loads.hpp"

#include <cmath>

#include "fiber_proximity/sim/loads.hpp"
#include "validation/sim/motion.hpp"
#include "validation/sim/rod_scene.hpp"
#include "validation/sim/root.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

std::unique_ptr<Loads> loads_with(Rods& rods, const Loads::Load& load) {
  auto loads = std::make_unique<Loads>();
  loads->add(rods, load);
  return loads;
}

constexpr double thick_bending_stiffness = 4.0;

/// The tip of a rod of length 1, level from a clamp, at rest under a load.
/// @param step length of its thick part
CantileverTip loaded_tip(int segments, double step, const Loads::Load& load) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, {1e7, 1.0, 1.0, 1.0, 1e-6});
  if (step > 0.0) {
    rods.set_sections(0, {{{0.0, step}, {1e7, thick_bending_stiffness, 1.0, 1.0, 1e-6}}});
  }
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})});
  auto loads = loads_with(rods, load);
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(clamped),
                          std::move(loads)),
                  precise());
  settle(stepper);
  const Vector3d& tip = stepper.rods().positions.back();
  return {-tip.z(), tip.x()};
}

/// Where a chain of weight 1 per length is after a length, pulled at its beginning by a level force
/// and an upward one: level, and up.
Eigen::Vector2d hung(double level, double upward, double length) {
  const double end = upward - length;
  return {level * (std::asinh(upward / level) - std::asinh(end / level)),
          std::hypot(level, end) - std::hypot(level, upward)};
}

}  // namespace

CantileverTip exact_arc_tip(double moment) {
  return {(1.0 - std::cos(moment)) / moment, std::sin(moment) / moment};
}

CantileverTip exact_stepped_arc_tip(double moment, double step) {
  // Two arcs one behind the other.
  const double first = moment / thick_bending_stiffness;
  const double turn = first * step;
  const double end = turn + moment * (1.0 - step);
  return {(1.0 - std::cos(turn)) / first + (std::cos(turn) - std::cos(end)) / moment,
          std::sin(turn) / first + (std::sin(end) - std::sin(turn)) / moment};
}

double exact_stepped_compliance(double step) {
  const double rest = std::pow(1.0 - step, 3) / 3.0;
  return (1.0 / 3.0 - rest) / thick_bending_stiffness + rest;
}

CantileverTip simulated_arc_tip(int segments, double moment) {
  return simulated_stepped_arc_tip(segments, moment, 0.0);
}

CantileverTip simulated_stepped_arc_tip(int segments, double moment, double step) {
  Loads::Load load;
  load.node = static_cast<std::uint32_t>(segments);
  load.moment = TimeTable<Vector3d>(Vector3d(0.0, moment, 0.0));
  return loaded_tip(segments, step, load);
}

double simulated_stepped_compliance(int segments, double step) {
  constexpr double force = 1e-3;
  Loads::Load load;
  load.node = static_cast<std::uint32_t>(segments);
  load.force = TimeTable<Vector3d>(Vector3d(0.0, 0.0, -force));
  return loaded_tip(segments, step, load).drop / force;
}

HangingChain exact_loaded_catenary(double length, double weight, double place) {
  // Level and upward force at the first end, so that the other end is where it is.
  struct Ends {
    Eigen::Vector2d weight;
    Eigen::Vector2d last;
  };
  const auto ends = [&](double level, double upward) {
    const Eigen::Vector2d first = hung(level, upward, place * length);
    const double after = upward - place * length - weight;
    return Ends{first, first + hung(level, after, (1.0 - place) * length)};
  };
  const auto upward_of = [&](double level) {
    return root_between([&](double upward) { return ends(level, upward).last.y(); }, 0.0,
                        length + weight);
  };
  const double pull = root_between(
      [&](double level) { return ends(level, upward_of(level)).last.x() - 1.0; }, 1e-3, 1e3);
  return {-ends(pull, upward_of(pull)).weight.y(), pull};
}

HangingChain simulated_loaded_catenary(double length, double weight, double place, int segments) {
  Rods rods;
  const double depth = 0.5 * std::sqrt(length * length - 1.0);
  std::vector<Vector3d> points = straight({0, 0, 0}, {0.5, 0, -depth}, segments / 2);
  points.pop_back();
  for (const Vector3d& point : straight({0.5, 0, -depth}, {1, 0, 0}, segments / 2)) {
    points.push_back(point);
  }
  const double stiffness = 1e6;
  rods.add(points, 0.001, {stiffness, 0.0, 0.0, 1.0, 0.0});
  auto pinned = hold(rods, {pin(0, points.front()), pin(segments, points.back())});
  Loads::Load load;
  load.node = static_cast<std::uint32_t>(std::lround(place * segments));
  load.mass = weight;
  auto loads = loads_with(rods, load);
  Stepper stepper(rods,
                  effects(std::make_unique<Gravity>(-Vector3d::UnitZ()),
                          std::make_unique<Stretch>(), std::move(pinned), std::move(loads)),
                  precise());
  settle(stepper);
  const std::vector<Vector3d>& positions = stepper.rods().positions;
  const Vector3d edge = positions[1] - positions[0];
  const double tension = stiffness * (edge.norm() / rods.rest_lengths[0] - 1.0);
  return {-positions[load.node].z(), tension * edge.normalized().x()};
}

double exact_weight_pendulum_period(double angle, double share) {
  return exact_pendulum_ratio(angle) * point_pendulum_period() *
         std::sqrt((1.0 + share / 3.0) / (1.0 + 0.5 * share));
}

double simulated_weight_pendulum_period(int segments, double angle, double share, double step) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {std::sin(angle), 0, -std::cos(angle)}, segments), 0.01,
           {1e5, 0.0, 0.0, share, 0.0});
  auto pinned = hold(rods, {pin(0, Vector3d::Zero())});
  Loads::Load load;
  load.node = rods.node_count(0) - 1;
  load.mass = 1.0;
  auto loads = loads_with(rods, load);
  auto inextensible = std::make_unique<Inextensible>(rods);
  return period_of_swing(rods,
                         effects(std::make_unique<Gravity>(pendulum_gravity),
                                 std::move(inextensible), std::move(pinned), std::move(loads)),
                         step);
}

}  // namespace fiber
