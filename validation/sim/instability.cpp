#include "validation/sim/instability.hpp"

#include <cassert>
#include <cmath>
#include <iterator>

#include "fiber_proximity/sim/effects.hpp"
#include "src/geometry/smallest_rotation.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "validation/sim/rod_scene.hpp"
#include "validation/sim/root.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

constexpr int rod_segments = 50;

/// Length, bending stiffness, twisting stiffness and mass are 1.
const RodSection unit_section{1e5, 1.0, 1.0, 1.0, 1e-4};

/// How far from its plane a rod is along an axis across it.
double distance_along(const Rods& rods, int axis) {
  double largest = 0.0;
  for (const Vector3d& position : rods.positions) {
    largest = std::max(largest, std::abs(position[axis]));
  }
  return largest;
}

/// How many times farther from where it was a rod is than shortly after it was disturbed.
template <class Advance, class Distance>
double growth(const Stepper& stepper, const Advance& advance, const Distance& distance, int steps) {
  for (int i = 0; i < steps / 4; ++i) {
    advance();
  }
  const double early = distance(stepper.rods());
  for (int i = 0; i < steps; ++i) {
    advance();
  }
  return distance(stepper.rods()) / early;
}

/// A step without inertia: an unstable shape is left without swinging.
void creep(Stepper& stepper, double step) {
  stepper.step(step);
  std::fill(stepper.rods().velocities.begin(), stepper.rods().velocities.end(), Vector3d::Zero());
  std::fill(stepper.rods().spins.begin(), stepper.rods().spins.end(), 0.0);
}

/// θ'' = -β (1 - s) θ from a clamp to an end without moment: where that has a solution, by a series
/// in β, each power of which follows from the last: θ = Σ (-β)^n r^(3n) / Π (3k)(3k-1), r = 1 - s.
double column_determinant(double weight) {
  double term = 1.0;
  double sum = 1.0;
  for (int k = 1; k < 30; ++k) {
    term *= -weight / (3.0 * k * (3.0 * k - 1.0));
    sum += term;
  }
  return sum;
}

/// By an angle that is the same per length [rad].
void twist_evenly(Rods& rods, double angle) {
  for (int i = 0; i < rod_segments; ++i) {
    rods.angles[i] = angle * (i + 0.5) / rod_segments;
  }
}

/// Twists a rod evenly, and clamps both ends.
std::unique_ptr<Attachment> clamp_twisted(Rods& rods, const Placement& first, const Placement& last,
                                          double angle) {
  twist_evenly(rods, angle);
  Placement turned = last;
  turned.director = Eigen::AngleAxisd(angle, last.tangent) * last.director;
  return hold(rods, {clamp(0, first), clamp(rod_segments, turned)});
}

/// Turns the ends of a rod against each other, each about its own tangent, by a constant moment.
class EndMoments : public Effect {
 public:
  explicit EndMoments(double moment) : moment_(moment) {}

  void energy(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
              SimdBatch& energy) const override {
    constexpr std::size_t unknowns = 4;
    energy = SimdBatch{};
    for (std::size_t lane = 0; lane < rods.used; ++lane) {
      const auto angle = [&](std::size_t edge) {
        return rods.positions[edge * unknowns + 3][lane];
      };
      energy[lane] = moment_ * (angle(0) - angle(rod_segments - 1));
    }
  }

  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                       PackSystem& system) const override {
    for (std::size_t lane = 0; lane < rods.used; ++lane) {
      RodSystem of_rod(system, lane);
      of_rod.add_angle_gradient(0, moment_);
      of_rod.add_angle_gradient(rod_segments - 1, -moment_);
    }
  }

 private:
  double moment_;  // [N m]
};

/// A straight rod that something holds twisted, disturbed to a side.
Stepper disturbed_stepper(Rods rods, std::unique_ptr<Twist> twist, Effects holding) {
  for (int i = 0; i <= rod_segments; ++i) {
    const double s = static_cast<double>(i) / rod_segments;
    rods.velocities[i].z() = 1e-7 * std::pow(std::sin(M_PI * s), 2);
  }
  Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist));
  std::move(holding.begin(), holding.end(), std::back_inserter(all));
  return {std::move(rods), std::move(all), precise()};
}

}  // namespace

double growth_of_column(double weight) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {0, 0, 1}, rod_segments), 0.01, unit_section);
  for (Vector3d& velocity : rods.velocities) {
    velocity.x() = 1e-7;
  }
  rods.velocities.front().setZero();
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitZ(), Vector3d::UnitX()})});
  Stepper stepper(
      rods,
      effects(std::make_unique<Gravity>(Vector3d(0, 0, -weight)), std::make_unique<Stretch>(),
              std::make_unique<Bend>(), std::move(clamped)),
      precise());
  return growth(
      stepper, [&] { stepper.step(0.2); }, [](const Rods& r) { return distance_along(r, 0); }, 100);
}

double critical_weight_of_column() { return root_between(column_determinant, 5.0, 10.0); }

double growth_of_twisted(double angle) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, rod_segments), 0.01, unit_section);
  auto twist = std::make_unique<Twist>(rods);
  const Vector3d director = rods.directors[0];
  auto clamped = clamp_twisted(rods, {Vector3d::Zero(), Vector3d::UnitX(), director},
                               {Vector3d::UnitX(), Vector3d::UnitX(), director}, angle);
  Stepper stepper = disturbed_stepper(rods, std::move(twist), effects(std::move(clamped)));
  return growth(
      stepper, [&] { stepper.step(0.02); }, [](const Rods& r) { return distance_along(r, 2); },
      200);
}

double growth_of_hinged(double moment) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, rod_segments), 0.01, unit_section);
  auto twist = std::make_unique<Twist>(rods);
  twist_evenly(rods, moment);
  auto pinned = hold(rods, {pin(0, Vector3d::Zero()), pin(rod_segments, Vector3d::UnitX())});
  Stepper stepper = disturbed_stepper(
      rods, std::move(twist), effects(std::move(pinned), std::make_unique<EndMoments>(moment)));
  const auto distance = [](const Rods& r) {
    return std::max(distance_along(r, 1), distance_along(r, 2));
  };
  return growth(
      stepper, [&] { creep(stepper, 0.05); }, distance, 300);
}

// Between clamps: tan x = x for x = ML/2EI.
double critical_twist() {
  return 2.0 * root_between([](double x) { return std::sin(x) - x * std::cos(x); }, 4.0, 5.0);
}

// Between hinges, w = (1 - cos kx) and (kx - sin kx) across the axis, k = M/EI, meet both ends at a
// full turn.
double critical_moment_of_hinged() { return 2.0 * M_PI; }

double growth_of_curved(double weight, double twisting_stiffness, double curvature) {
  RodSection section = unit_section;
  section.twisting_stiffness = twisting_stiffness;
  const Vector3d down = -Vector3d::UnitZ();
  Rods rods;
  rods.add(straight({0, 0, 0}, down, rod_segments), 0.01, section);
  auto twist = std::make_unique<Twist>(rods);
  set_natural_arc(rods, 0, curvature, Vector3d::UnitX());
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), down, rods.directors[0]})});
  Stepper stepper(rods,
                  effects(std::make_unique<Gravity>(weight * down), std::make_unique<Stretch>(),
                          std::make_unique<Bend>(), std::move(twist), std::move(clamped)),
                  precise());
  settle(stepper);
  assert(distance_along(stepper.rods(), 1) < 1e-9);
  for (int i = 1; i <= rod_segments; ++i) {
    stepper.rods().velocities[i].y() = 1e-7 * i / rod_segments;
  }
  return growth(
      stepper, [&] { creep(stepper, 0.2); }, [](const Rods& r) { return distance_along(r, 1); },
      200);
}

EndOfRing end_of_ring(double angle, int steps) {
  std::vector<Vector3d> points;
  const double radius = 0.5 / (rod_segments * std::sin(M_PI / rod_segments));
  for (int i = 0; i <= rod_segments; ++i) {
    const double turn = 2.0 * M_PI * (i % rod_segments) / rod_segments;
    points.emplace_back(radius * std::sin(turn), radius * (1.0 - std::cos(turn)), 0.0);
  }
  Rods rods;
  rods.add(points, 0.01, unit_section);
  auto twist = std::make_unique<Twist>(rods);
  // The first edge is half a node's turn after the clamp.
  const Vector3d tangent = Vector3d::UnitX();
  const auto back = smallest_rotation(points[1] - points[0], tangent);
  const Placement placement{Vector3d::Zero(), tangent, back * rods.directors[0]};
  auto clamped = clamp_twisted(rods, placement, placement, angle);
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::move(clamped)),
                  precise());
  for (int i = 0; i < steps; ++i) {
    stepper.step(0.02);
  }
  return {stepper.rods().positions[rod_segments / 2].y(), distance_along(stepper.rods(), 2)};
}

double critical_twist_of_ring() { return 2.0 * M_PI * std::sqrt(3.0); }

}  // namespace fiber
