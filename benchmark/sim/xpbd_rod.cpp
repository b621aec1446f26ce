#include "benchmark/sim/xpbd_rod.hpp"

#include <algorithm>

#include "src/geometry/smallest_rotation.hpp"

namespace fiber {

using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

Quaterniond pure(const Vector3d& v) { return {0.0, v.x(), v.y(), v.z()}; }

void add(Quaterniond& to, double factor, const Quaterniond& what) {
  to.coeffs() += factor * what.coeffs();
}

/// Direction of an edge in a frame of unit length: its third axis.
Vector3d third_axis(const Quaterniond& frame) { return frame * Vector3d::UnitZ(); }

}  // namespace

XpbdRod::XpbdRod(const std::vector<Vector3d>& points, const RodSection& section, double inertia)
    : section_(section),
      edge_length_((points[1] - points[0]).norm()),
      positions_(points),
      velocities_(points.size(), Vector3d::Zero()),
      weights_(points.size(), 1.0 / (section.mass_per_length * edge_length_)),
      frames_(points.size(), smallest_rotation(Vector3d::UnitZ(), points[1] - points[0])),
      spins_(points.size(), Vector3d::Zero()),
      stretch_multipliers_(points.size() - 1),
      bend_multipliers_(points.size() - 1) {
  weights_.front() = 0.0;
  weights_.back() *= 2.0;  // half an edge
  // A quaternion's mass is four times the inertia, here that of the cross-section, ρJ: what an
  // edge's length adds is in the masses of its nodes.
  turn_weight_ = 0.25 / (inertia * section.inertia_per_length * edge_length_);
}

void XpbdRod::step(double length, const Vector3d& acceleration) {
  predict(length, acceleration);
  std::fill(stretch_multipliers_.begin(), stretch_multipliers_.end(), Vector3d::Zero());
  std::fill(bend_multipliers_.begin(), bend_multipliers_.end(), Vector3d::Zero());
  for (std::size_t i = 0; i + 1 < positions_.size(); ++i) {
    project_bend(i, length);
    project_stretch(i, length);
  }
  find_velocities(length);
}

void XpbdRod::damp(double factor) {
  for (Vector3d& velocity : velocities_) {
    velocity *= factor;
  }
  for (Vector3d& spin : spins_) {
    spin *= factor;
  }
}

void XpbdRod::predict(double length, const Vector3d& acceleration) {
  start_positions_ = positions_;
  start_frames_ = frames_;
  for (std::size_t i = 1; i < positions_.size(); ++i) {
    velocities_[i] += length * acceleration;
    positions_[i] += length * velocities_[i];
    add(frames_[i], 0.5 * length, pure(spins_[i]) * frames_[i]);
    frames_[i].normalize();
  }
}

/// C = (p₂ - p₁) / l - d₃(q), against stretch and shear, with the stiffness EA of stretch.
void XpbdRod::project_stretch(std::size_t edge, double step) {
  Quaterniond& frame = frames_[edge + 1];
  const double l = edge_length_;
  const double compliance = 1.0 / (section_.stretching_stiffness * l * step * step);
  const Vector3d constraint = (positions_[edge + 1] - positions_[edge]) / l - third_axis(frame);
  const double weight =
      (weights_[edge] + weights_[edge + 1]) / (l * l) + 4.0 * turn_weight_ + compliance;
  const Vector3d change = -(constraint + compliance * stretch_multipliers_[edge]) / weight;
  stretch_multipliers_[edge] += change;
  positions_[edge] -= weights_[edge] / l * change;
  positions_[edge + 1] += weights_[edge + 1] / l * change;
  add(frame, 2.0 * turn_weight_, pure(change) * frame * pure(Vector3d::UnitZ()));
  frame.normalize();
}

/// C = Im(q̄₁ q₂), half the angles from frame to frame; the first is the clamp, half an edge away.
void XpbdRod::project_bend(std::size_t node, double step) {
  Quaterniond& before = frames_[node];
  Quaterniond& after = frames_[node + 1];
  const double l = node == 0 ? 0.5 * edge_length_ : edge_length_;
  const double bend = section_.bending_stiffness;
  const Vector3d stiffness(bend, bend, section_.twisting_stiffness);
  const Vector3d compliance = (0.25 * l / (step * step)) * stiffness.cwiseInverse();
  const double weight_before = node == 0 ? 0.0 : turn_weight_;
  const Vector3d constraint = (before.conjugate() * after).vec();
  const Vector3d weight = compliance.array() + (weight_before + turn_weight_);
  const Vector3d change =
      -(constraint + compliance.cwiseProduct(bend_multipliers_[node])).cwiseQuotient(weight);
  bend_multipliers_[node] += change;
  const Quaterniond of_before = after * pure(change);
  add(after, turn_weight_, before * pure(change));
  add(before, -weight_before, of_before);
  after.normalize();
  before.normalize();
}

void XpbdRod::find_velocities(double length) {
  for (std::size_t i = 1; i < positions_.size(); ++i) {
    velocities_[i] = (positions_[i] - start_positions_[i]) / length;
    spins_[i] = 2.0 / length * (frames_[i] * start_frames_[i].conjugate()).vec();
  }
}

}  // namespace fiber
