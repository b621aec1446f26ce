#include "validation/sim/joints.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/joints.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// The lower end of a half of the ring, from its upper one: angle, level way, height; and how far
/// level it went.
struct HalfRing {
  double angle = 0.0;
  double x = 0.0;
  double z = 0.0;
  double farthest = 0.0;
};

/// @param start its curvature above, and the level force
HalfRing half_ring(double weight, const Vector2d& start) {
  constexpr int steps = 2000;
  constexpr double step = 0.5 / steps;
  Eigen::Vector4d state(0.0, start[0], 0.0, 0.0);  // angle, curvature, x, z
  const auto rate = [&](double s, const Eigen::Vector4d& y) {
    return Eigen::Vector4d(y[1], start[1] * std::sin(y[0]) + weight * (0.5 - s) * std::cos(y[0]),
                           std::cos(y[0]), std::sin(y[0]));
  };
  HalfRing half;
  for (int i = 0; i < steps; ++i) {
    const double s = i * step;
    const Eigen::Vector4d a = rate(s, state);
    const Eigen::Vector4d b = rate(s + 0.5 * step, state + 0.5 * step * a);
    const Eigen::Vector4d c = rate(s + 0.5 * step, state + 0.5 * step * b);
    const Eigen::Vector4d d = rate(s + step, state + step * c);
    state += step / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    half.farthest = std::max(half.farthest, state[2]);
  }
  half.angle = state[0];
  half.x = state[2];
  half.z = state[3];
  return half;
}

}  // namespace

HungRing exact_hung_ring(double weight) {
  Vector2d start(-2.0 * M_PI, 0.0);  // of a circle without weight
  constexpr int loads = 50;
  for (int load = 0; load <= loads; ++load) {
    const double now = weight * load / loads;
    const auto missing = [&](const Vector2d& from) {
      const HalfRing half = half_ring(now, from);
      return Vector2d(half.angle + M_PI, half.x);
    };
    constexpr int iterations = 8;
    for (int i = 0; i < iterations; ++i) {
      constexpr double difference = 1e-5;
      Eigen::Matrix2d slopes;
      for (int k = 0; k < 2; ++k) {
        const Vector2d change = difference * Vector2d::Unit(k);
        slopes.col(k) = (missing(start + change) - missing(start - change)) / (2.0 * difference);
      }
      start -= slopes.inverse() * missing(start);
    }
  }
  const HalfRing half = half_ring(weight, start);
  return {-half.z, 2.0 * half.farthest};
}

HungRing simulated_hung_ring(double weight, int segments) {
  std::vector<Vector3d> points;
  const double radius = 0.5 / (segments * std::sin(M_PI / segments));
  for (int i = 0; i < segments; ++i) {
    const double angle = 2.0 * M_PI * i / segments;
    points.emplace_back(radius * std::sin(angle), 0.0, radius * std::cos(angle));
  }
  points.push_back(points.front());
  Rods rods;
  rods.add(points, 0.001, {1e6, 1.0, 1.0, 1.0, 1e-6});
  auto joints = std::make_unique<Joints>(Joints::Options{});
  joints->close(rods, 0);
  // Held at some node, not where its ends meet.
  const auto top = static_cast<std::uint32_t>(segments / 3);
  auto held = hold(rods, {pin(top, points[top])});
  const double turn = 2.0 * M_PI * top / segments;
  const Vector3d down(-std::sin(turn), 0.0, -std::cos(turn));
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                          std::make_unique<Gravity>(weight * down), std::move(held)),
                  precise(), nullptr, std::move(joints));
  settle(stepper);
  HungRing ring{0.0, 0.0};
  const Vector3d level(down.z(), 0.0, -down.x());
  const std::vector<Vector3d>& found = stepper.rods().positions;
  for (const Vector3d& a : found) {
    ring.drop = std::max(ring.drop, down.dot(a - found[top]));
    for (const Vector3d& b : found) {
      ring.width = std::max(ring.width, level.dot(a - b));
    }
  }
  return ring;
}

namespace {

const std::array<Vector3d, 2> supports{Vector3d(-1.0, 0.0, 0.5), Vector3d(0.25, 0.0, 0.5)};

}  // namespace

std::array<double, 2> exact_truss() {
  Eigen::Matrix2d balance;
  for (int i = 0; i < 2; ++i) {
    const Vector3d along = supports[static_cast<std::size_t>(i)].normalized();
    balance.col(i) = Vector2d(along.x(), along.z());
  }
  const Vector2d pulls = balance.inverse() * Vector2d(0.0, 1.0);
  return {pulls[0], pulls[1]};
}

std::array<double, 2> simulated_truss() {
  constexpr double gravity = 10.0;
  const RodSection light{1e7, 1.0, 1.0, 1e-6, 1e-9};
  const RodSection heavy{1e7, 1.0, 1.0, 1.0, 1e-6};
  Rods rods;
  for (const Vector3d& support : supports) {
    rods.add(straight(support, Vector3d::Zero(), 1), 0.01, light);
  }
  rods.add(straight(Vector3d::Zero(), {0.0, 0.0, -1.0}, 4), 0.01, heavy);
  auto joints = std::make_unique<Joints>(Joints::Options{});
  joints->add(rods, {Joints::Kind::BALL, {{0, 1}, {1, 1}, {2, 0}}});
  Attachment::Hold other = pin(0, supports[1]);
  other.rod = 1;
  auto held = hold(rods, {pin(0, supports[0]), other});
  Stepper stepper(rods,
                  effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                          std::make_unique<Gravity>(Vector3d(0.0, 0.0, -gravity)), std::move(held)),
                  precise(), nullptr, std::move(joints));
  settle(stepper);
  const RodForces forces = stepper.forces();
  return {forces.joints[0].force.norm() / gravity, forces.joints[1].force.norm() / gravity};
}

}  // namespace fiber
