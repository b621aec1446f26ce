#include "validation/sim/friction_scenes.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fiber_proximity/sim/joints.hpp"
#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

constexpr double step_length = 1.0 / 240.0;  // [s]

constexpr double post_radius = 0.05;  // [m]

/// In parts of the post's, so that the strain is a few parts in ten thousand before the post: it
/// grows with the square of this and the bending share.
double rope_radius(const RodMaterial& material) {
  return post_radius * std::min(0.03, 1e-3 / std::sqrt(material.bending_share));
}

/// Nodes of a rope that is straight, around the post, and straight again: a polygon around the
/// circle of the axis whose edges touch that in their middles, so that none begins in the post.
std::vector<Vector3d> around_post(const Capstan& capstan, double axis_radius, double rise) {
  const double turn = 2.0 * M_PI / capstan.edges_per_turn;
  const double edge = 2.0 * axis_radius * std::tan(0.5 * turn);
  const int corners = static_cast<int>(std::lround(capstan.turns * capstan.edges_per_turn));
  const int straight_edges = std::max(6, static_cast<int>(0.06 / edge));
  std::vector<Vector3d> points;
  for (int node = -straight_edges; node < corners + straight_edges; ++node) {
    // On the line that touches the circle at this angle.
    const int touching = std::clamp(node, 0, corners);
    const double angle = turn * touching;
    const double along = edge * (node - touching + 0.5);
    points.emplace_back(axis_radius * std::cos(angle) - along * std::sin(angle),
                        axis_radius * std::sin(angle) + along * std::cos(angle), rise * node);
  }
  return points;
}

}  // namespace

Incline::Incline(double angle, double friction)
    : down_(std::cos(angle), 0.0, -std::sin(angle)),
      normal_(std::sin(angle), 0.0, std::cos(angle)) {
  constexpr double radius = 0.005;
  const Vector3d start = radius * normal_;
  Rods rods;
  rods.add(straight(start, start + Vector3d(0.0, 0.2, 0.0), 10), radius, rubber(radius));
  stepper_ = std::make_unique<Stepper>(
      rods, elastic(standard_gravity), StepperOptions{},
      contacts_with(environment_of(HalfSpaceShape{normal_, 0.0}), friction));
}

void Incline::run(double time) {
  for (int i = 0; i < std::lround(time / step_length); ++i) {
    stepper_->step(step_length);
  }
}

double Incline::mass() const {
  double mass = 0.0;
  for (const double m : stepper_->rods().masses) {
    mass += m;
  }
  return mass;
}

double Incline::speed() const { return momentum_of(stepper_->rods()).dot(down_) / mass(); }

double Incline::weight() const { return mass() * standard_gravity; }

double Incline::friction_force() const {
  double force = 0.0;
  for (const RodForces::ContactForce& contact : stepper_->forces().contacts) {
    force -= contact.friction_force.dot(down_);
  }
  return force;
}

double Incline::normal_force() const {
  double force = 0.0;
  for (const RodForces::ContactForce& contact : stepper_->forces().contacts) {
    force += contact.normal_force.dot(normal_);
  }
  return force;
}

namespace {

/// A cylinder along z that turns about its axis.
/// @param turn_rate [rad/s]
MovingObstacle drum_at(const Vector3d& center, double radius, double turn_rate) {
  return moving("drum of " + std::to_string(radius) + " m", CylinderShape{radius, 1.0},
                [center, turn_rate](double time) {
                  return Eigen::Isometry3d(Eigen::Translation3d(center) *
                                           Eigen::AngleAxisd(turn_rate * time, Vector3d::UnitZ()));
                });
}

/// The post, which turns the other way at the speed at which a rope is drawn, or stands.
std::unique_ptr<Contacts> contacts_with_post(double turn_rate, double friction) {
  if (turn_rate != 0.0) {
    return contacts_with_moving({drum_at(Vector3d::Zero(), post_radius, -turn_rate)}, friction);
  }
  std::vector<std::unique_ptr<ContactSource>> sources;
  sources.push_back(std::make_unique<EnvironmentContact>(
      environment_of(CylinderShape{post_radius, 1.0}), EnvironmentContact::Options{}));
  return std::make_unique<Contacts>(std::move(sources),
                                    std::make_unique<Friction>(Friction::Options{friction, 1e-3}));
}

double ratio_of_tensions(const Capstan& capstan, double friction, bool turns_post) {
  const RodMaterial material = material_preset(capstan.material);
  const double radius = rope_radius(material);
  const double axis_radius = post_radius + radius;
  constexpr double beside = 2.5;  // radii from turn to turn
  const std::vector<Vector3d> points =
      around_post(capstan, axis_radius, beside * radius / capstan.edges_per_turn);
  const auto last = static_cast<std::uint32_t>(points.size()) - 1;
  Rods rods;
  rods.add(points, radius, solid_round_section(material, radius));

  constexpr double stiffness_share = 1e-3;
  Attachment::Hold load = pin(0, points[0] + 10.0 * (points[0] - points[1]).normalized());
  load.max_force =
      rods.sections[0].bending_stiffness / (stiffness_share * axis_radius * axis_radius);
  // Drawn by a force it would run away; so the other end moves at a steady speed.
  constexpr int steps_per_edge = 48;
  const Vector3d edge = points[last] - points[last - 1];
  Attachment::Hold pull = pin(last, points[last]);
  pull.placement = [=, start = points[last]](double time) {
    const double way = turns_post ? 0.0 : time / (steps_per_edge * step_length);
    return Placement{start + way * edge, Vector3d::Zero(), Vector3d::Zero()};
  };
  Effects all = elastic();
  all.push_back(hold(rods, {load, pull}));
  const double turn_rate =
      turns_post ? 2.0 * M_PI / (capstan.edges_per_turn * steps_per_edge * step_length) : 0.0;
  Stepper stepper(rods, std::move(all), StepperOptions{}, contacts_with_post(turn_rate, friction));
  double before = 0.0;
  double beyond = 0.0;
  std::uint32_t unbalanced = 0;
  constexpr int edges_before = 3;  // until all of it slides
  constexpr int steps = (edges_before + 1) * steps_per_edge;
  for (int i = 0; i < steps; ++i) {
    stepper.step(step_length);
    unbalanced += stepper.report().unbalanced;
    if (i >= edges_before * steps_per_edge) {
      const RodForces forces = stepper.forces();
      before += forces.tensions[1];
      beyond += forces.tensions[last - 2];
    }
  }
  constexpr std::uint32_t most_unbalanced = steps / 20;
  if (unbalanced > most_unbalanced) {
    throw std::runtime_error(std::to_string(unbalanced) + " of " + std::to_string(steps) +
                             " steps ended before forces balanced");
  }
  return beyond / before;
}

}  // namespace

double tension_ratio(const Capstan& capstan, double friction) {
  return ratio_of_tensions(capstan, friction, false);
}

double tension_ratio_on_drum(const Capstan& capstan, double friction) {
  return ratio_of_tensions(capstan, friction, true);
}

namespace {

constexpr double belt_radius = 1e-3;  // [m] of its cross-section
constexpr double large_drum = 0.04;   // [m] radii
constexpr double small_drum = 0.02;
constexpr double drum_distance = 0.1;  // [m] of their axes, along x from the large one

/// From x to where the belt leaves both drums: half of the angle by which it is around the small
/// one.
double angle_of_leaving() { return std::acos((large_drum - small_drum) / drum_distance); }

/// A loop around both drums, a little away from them: an edge of a polygon is nearer than its ends.
std::vector<Vector3d> around_drums(int edges_per_small_turn) {
  constexpr double away = 1.05 * belt_radius;
  const double large = large_drum + away;
  const double small = small_drum + away;
  const double leaving = angle_of_leaving();
  const double straight =
      std::sqrt(drum_distance * drum_distance - (large - small) * (large - small));
  const double on_large = large * 2.0 * (M_PI - leaving);
  const double on_small = small * 2.0 * leaving;
  const double length = on_large + on_small + 2.0 * straight;
  const auto on_circle = [](double center, double radius, double angle) {
    return Vector3d(center + radius * std::cos(angle), radius * std::sin(angle), 0.0);
  };
  const auto point_at = [&](double way) -> Vector3d {
    if (way < on_large) {
      return on_circle(0.0, large, leaving + way / large);
    }
    way -= on_large;
    const Vector3d across = on_circle(0.0, 1.0, -leaving);
    const Vector3d along(-across.y(), across.x(), 0.0);
    if (way < straight) {
      return large * across + way * along;
    }
    way -= straight;
    if (way < on_small) {
      return on_circle(drum_distance, small, -leaving + way / small);
    }
    const Vector3d last = on_circle(drum_distance, small, leaving);
    return last + (way - on_small) * Vector3d(-std::sin(leaving), std::cos(leaving), 0.0);
  };
  const auto edges =
      static_cast<int>(std::lround(length / (2.0 * M_PI * small / edges_per_small_turn)));
  std::vector<Vector3d> points;
  for (int i = 0; i < edges; ++i) {
    points.push_back(point_at(length * i / edges));
  }
  points.push_back(points.front());
  return points;
}

}  // namespace

BeltDrive simulated_belt_drive(bool turns_large, double friction) {
  constexpr double strain = 2e-3;
  constexpr int steps_per_edge = 48;
  constexpr int edges_before = 5;  // until all of it slides
  const std::vector<Vector3d> points = around_drums(belt_edges_per_turn);
  Rods rods;
  rods.add(points, belt_radius, solid_round_section(material_preset("rope"), belt_radius));
  rods.closed = {1};
  for (double& length : rods.rest_lengths) {
    length *= 1.0 - strain;
  }
  auto joints = std::make_unique<Joints>(Joints::Options{});
  joints->close(rods, 0);
  const double speed = rods.rest_lengths[0] / (steps_per_edge * step_length);
  const double turn_rate = speed / (turns_large ? large_drum : small_drum);
  Stepper stepper(
      rods, elastic(), StepperOptions{},
      contacts_with_moving(
          {drum_at(Vector3d::Zero(), large_drum, turns_large ? turn_rate : 0.0),
           drum_at({drum_distance, 0.0, 0.0}, small_drum, turns_large ? 0.0 : turn_rate)},
          friction),
      std::move(joints));
  double upper = 0.0;  // tensions of the middles of both straight parts
  double lower = 0.0;
  double way = 0.0;
  for (int i = 0; i < (edges_before + 1) * steps_per_edge; ++i) {
    stepper.step(step_length);
    if (i < edges_before * steps_per_edge) {
      continue;
    }
    const Rods& now = stepper.rods();
    const RodForces forces = stepper.forces();
    double along = 0.0;
    for (std::uint32_t edge = 0; edge + 1 < now.node_count(0); ++edge) {
      const Vector3d middle = 0.5 * (now.positions[edge] + now.positions[edge + 1]);
      const Vector3d tangent = (now.positions[edge + 1] - now.positions[edge]).normalized();
      along += now.velocities[edge].dot(tangent);
      if (std::abs(middle.x() - 0.5 * drum_distance) < 0.2 * drum_distance) {
        (middle.y() > 0.0 ? upper : lower) += forces.tensions[edge];
      }
    }
    way += step_length * along / (now.node_count(0) - 1);
  }
  return {std::max(upper, lower) / std::min(upper, lower),
          way / (speed * steps_per_edge * step_length)};
}

BeltDrive exact_belt_drive(bool turns_large, double friction) {
  return {std::exp(friction * 2.0 * angle_of_leaving()),
          turns_large ? 1.0 + belt_radius / large_drum : 0.0};
}

double lowering_of_simulated_tip(double friction, int segments) {
  constexpr double radius = 1e-3;
  constexpr double step = 0.01;
  constexpr double speed = 0.01;
  constexpr double slid = 2e-5;  // twice as far as it gives way while it sticks
  const Vector3d down = -Vector3d::UnitZ();
  const Vector3d top(0.0, 0.0, 1.0 + 1.04 * radius);
  Rods rods;
  rods.add(straight(top, top + down, segments), radius, {1e5, 1.0, 1.0, 1.0, 1e-4});
  const auto lower = [=](double time) {
    return Placement{top + speed * time * down, down, Vector3d::UnitX()};
  };
  for (int i = 1; i < segments; ++i) {
    rods.velocities[i].x() = 1e-3;  // to which side it buckles
  }
  Effects all = elastic();
  all.push_back(std::make_unique<Damping>(0.1));  // or it would slide as it buckles
  all.push_back(hold(rods, {{0, 0, Attachment::Kind::CLAMP, lower}}));
  StepperOptions options;
  options.residual = 1e-6;
  Stepper stepper(rods, std::move(all), options,
                  contacts_with(environment_of(HalfSpaceShape{Vector3d::UnitZ(), 0.0}), friction));
  const Vector3d& tip = stepper.rods().positions[segments];
  while (std::abs(tip.x()) < slid) {
    stepper.step(step);
  }
  return 1.0 - (stepper.rods().positions[0] - tip).z();
}

}  // namespace fiber
