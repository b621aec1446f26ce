#include "moving_rod.hpp"

#include <algorithm>

namespace fiber {

using Eigen::Vector3d;

MovingRod::MovingRod(const Rods& rods, std::uint32_t rod)
    : rod_(rod),
      first_(rods.first(rod)),
      count_(rods.node_count(rod)),
      system_(count_, rods.angles.empty() ? 3 : 4) {}

void MovingRod::begin(Rods& rods, double step) {
  step_ = step;
  store(rods, begin_);
  for (std::uint32_t i = first_; i < first_ + count_; ++i) {
    rods.positions[i] += step * rods.velocities[i];
  }
  for (std::size_t i = 0; i < begin_.angles.size(); ++i) {
    rods.angles[first_ + i] += step * rods.spins[first_ + i];
  }
  held_.clear();
  const auto is_before = [](const HeldNode& held, std::uint32_t node) { return held.node < node; };
  auto held = std::lower_bound(rods.held.begin(), rods.held.end(), first_, is_before);
  for (; held != rods.held.end() && held->node < first_ + count_; ++held) {
    rods.positions[held->node] = held->position;
    held_.push_back(held->node - first_);
  }
  store(rods, predicted_);
}

void MovingRod::store(const Rods& rods, State& state) const {
  state.positions.assign(rods.positions.begin() + first_, rods.positions.begin() + first_ + count_);
  if (!rods.angles.empty()) {
    state.angles.assign(rods.angles.begin() + first_, rods.angles.begin() + first_ + count_);
  }
}

Merit MovingRod::merit(const Rods& rods, const Effects& effects) const {
  double kinetic = 0.0;
  for (std::uint32_t i = 0; i < count_; ++i) {
    kinetic += rods.masses[first_ + i] *
               (rods.positions[first_ + i] - predicted_.positions[i]).squaredNorm();
  }
  for (std::uint32_t i = 0; i + 1 < predicted_.angles.size(); ++i) {
    const double change = rods.angles[first_ + i] - predicted_.angles[i];
    kinetic +=
        rods.sections[rod_].inertia_per_length * rods.rest_lengths[first_ + i] * change * change;
  }
  Merit merit;
  merit.add(0.5 * kinetic / (step_ * step_));
  for (const std::unique_ptr<Effect>& effect : effects) {
    merit.add(effect->energy(rods, rod_));
  }
  return merit;
}

void MovingRod::assemble(const Rods& rods, const Effects& effects) {
  system_.set_zero();
  const double inverse_square = 1.0 / (step_ * step_);
  for (std::uint32_t i = 0; i < count_; ++i) {
    const double inertia = rods.masses[first_ + i] * inverse_square;
    system_.add_gradient(i, inertia * (rods.positions[first_ + i] - predicted_.positions[i]));
    system_.add_hessian(i, inertia * Eigen::Matrix3d::Identity());
  }
  for (std::uint32_t i = 0; i < predicted_.angles.size(); ++i) {
    // After the last node there is no edge: its angle stays as it is.
    const double length = i + 1 < count_ ? rods.rest_lengths[first_ + i] : 1.0;
    const double inertia = rods.sections[rod_].inertia_per_length * length * inverse_square;
    system_.add_angle_gradient(i, inertia * (rods.angles[first_ + i] - predicted_.angles[i]));
    const std::size_t index = std::size_t{i} * system_.unknowns() + 3;
    system_.add_hessian_entry(index, index, inertia);
  }
  for (const std::unique_ptr<Effect>& effect : effects) {
    effect->add_derivatives(rods, rod_, system_);
  }
}

void MovingRod::factorise() {
  for (const std::uint32_t node : held_) {
    system_.hold(node);
  }
  system_.factorise();
}

void MovingRod::load(const State& state, Rods& rods) const {
  std::copy(state.positions.begin(), state.positions.end(), rods.positions.begin() + first_);
  if (!state.angles.empty()) {
    std::copy(state.angles.begin(), state.angles.end(), rods.angles.begin() + first_);
  }
}

void MovingRod::restore(Rods& rods) const { load(iterate_, rods); }

void MovingRod::predict(Rods& rods) const { load(predicted_, rods); }

void MovingRod::carry(Rods& rods) const {
  load(begin_, rods);
  if (held_.empty()) {
    double mass = 0.0;
    Vector3d drift = Vector3d::Zero();
    for (std::uint32_t i = 0; i < count_; ++i) {
      mass += rods.masses[first_ + i];
      drift += rods.masses[first_ + i] * (predicted_.positions[i] - begin_.positions[i]);
    }
    for (std::uint32_t i = 0; i < count_; ++i) {
      rods.positions[first_ + i] += drift / mass;
    }
  }
  for (const std::uint32_t node : held_) {
    rods.positions[first_ + node] = predicted_.positions[node];
  }
}

void MovingRod::move(Rods& rods, const double* displacements, double share) const {
  const std::uint32_t unknowns = system_.unknowns();
  for (std::uint32_t i = 0; i < count_; ++i) {
    rods.positions[first_ + i] =
        iterate_.positions[i] +
        share * Eigen::Map<const Vector3d>(displacements + std::size_t{i} * unknowns);
  }
  for (std::uint32_t i = 0; i + 1 < iterate_.angles.size(); ++i) {
    rods.angles[first_ + i] =
        iterate_.angles[i] + share * displacements[std::size_t{i} * unknowns + 3];
  }
}

void MovingRod::finish(Rods& rods) const {
  for (std::uint32_t i = 0; i < count_; ++i) {
    rods.velocities[first_ + i] = (rods.positions[first_ + i] - begin_.positions[i]) / step_;
  }
  for (std::size_t i = 0; i < begin_.angles.size(); ++i) {
    rods.spins[first_ + i] = (rods.angles[first_ + i] - begin_.angles[i]) / step_;
  }
}

}  // namespace fiber
