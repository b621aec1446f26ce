#include "sim/friction_scenes.hpp"

#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/contact_stiffness.hpp"
#include "sim/contact_scenes.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

constexpr double step_length = 1.0 / 240.0;  // [s]

/// Constant forces on the first node of the first rod and, unless it is held, its last.
class EndForces : public Effect {
 public:
  EndForces(const Vector3d& first, const Vector3d& last) : first_(first), last_(last) {}

  double energy(const Rods& rods, std::uint32_t /*rod*/) const override {
    return -first_.dot(rods.positions.front()) - last_.dot(rods.positions.back());
  }
  void add_derivatives(const Rods& rods, std::uint32_t /*rod*/, RodSystem& system) const override {
    system.add_gradient(0, -first_);
    system.add_gradient(rods.node_count(0) - 1, -last_);
  }

 private:
  Vector3d first_;
  Vector3d last_;
};

constexpr double post_radius = 0.05;
constexpr double rope_radius = 0.004;

/// Where the axis of the rope is, by how far along it from the middle [m]: straight, around the
/// post by the angle, and straight.
Vector3d on_rope(double along, double angle) {
  const double radius = post_radius + rope_radius;
  const double turned = std::clamp(along / radius, -0.5 * angle, 0.5 * angle);
  const double beyond = along - radius * turned;
  // Turns lie beside each other.
  const double rise = 2.5 * rope_radius * turned / (2.0 * M_PI);
  return {radius * std::cos(turned) - beyond * std::sin(turned),
          radius * std::sin(turned) + beyond * std::cos(turned), rise};
}

}  // namespace

Incline::Incline(double angle, double friction) : down_(std::cos(angle), 0.0, -std::sin(angle)) {
  constexpr double radius = 0.005;
  const Vector3d normal(std::sin(angle), 0.0, std::cos(angle));
  Rods rods;
  // So deep that nodes rest: its weight is what presses it.
  const RodSection section = rubber(radius);
  const double weight = section.mass_per_length * 0.02 * standard_gravity * std::cos(angle);
  const double stiffness = material_contact_stiffness(section, radius);
  const Vector3d start = (radius - weight / stiffness) * normal;
  rods.add(straight(start, start + Vector3d(0.0, 0.2, 0.0), 10), radius, section);
  stepper_ = std::make_unique<Stepper>(
      rods, elastic(standard_gravity), StepperOptions{},
      contacts_with(environment_of(HalfSpaceShape{normal, 0.0}), friction));
}

void Incline::run(double time) {
  for (int i = 0; i < std::lround(time / step_length); ++i) {
    stepper_->step(step_length);
  }
}

double Incline::speed() const {
  const Rods& rods = stepper_->rods();
  double mass = 0.0;
  for (const double m : rods.masses) {
    mass += m;
  }
  return momentum_of(rods).dot(down_) / mass;
}

double tension_ratio(const Capstan& capstan, double friction) {
  const double angle = 2.0 * M_PI * capstan.turns;
  const double edge = 2.0 * M_PI * (post_radius + rope_radius) / capstan.edges_per_turn;
  const double half = 0.5 * angle * (post_radius + rope_radius) + 0.12;
  const int half_count = static_cast<int>(half / edge);
  std::vector<Vector3d> points;
  for (int i = -half_count; i <= half_count; ++i) {
    points.push_back(on_rope(i * edge, angle));
  }
  RodSection section = rubber(rope_radius);
  section.bending_stiffness *= 1e-6;
  Rods rods;
  rods.add(points, rope_radius, section);
  const auto outwards = [&](int end, int next) {
    return (points[end] - points[next]).normalized();
  };
  const int last = static_cast<int>(points.size()) - 1;
  const Vector3d pull = outwards(last, last - 1);
  std::vector<std::unique_ptr<Effect>> effects = elastic();
  // Pulled by a force that the rope's speed resists in no way, it would run away: the last node
  // moves at a steady speed instead.
  effects.push_back(std::make_unique<EndForces>(outwards(0, 1), Vector3d::Zero()));
  std::vector<std::unique_ptr<ContactSource>> sources;
  EnvironmentContact::Options options;
  options.stiffness = 8000.0;
  sources.push_back(std::make_unique<EnvironmentContact>(
      environment_of(CylinderShape{post_radius, 1.0}), options));
  Stepper stepper(
      rods, std::move(effects), StepperOptions{},
      std::make_unique<Contacts>(std::move(sources),
                                 std::make_unique<Friction>(Friction::Options{friction, 1e-3})));
  constexpr double speed = 0.05;
  const auto tension = [&](std::uint32_t at) {
    const Rods& r = stepper.rods();
    return (r.positions[at + 1] - r.positions[at]).norm() / r.rest_lengths[at] - 1.0;
  };
  double before = 0.0;
  double beyond = 0.0;
  for (int i = 0; i < 360; ++i) {
    const Vector3d held = points[last] + speed * (i + 1) * step_length * pull;
    stepper.rods().held = {{static_cast<std::uint32_t>(last), held}};
    stepper.step(step_length);
    if (i >= 240) {
      before += tension(1);
      beyond += tension(static_cast<std::uint32_t>(last) - 2);
    }
  }
  return beyond / before;
}

}  // namespace fiber
