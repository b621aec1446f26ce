#include "fiber_proximity/sim/stepper.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "src/sim/inertia.hpp"
#include "src/sim/require.hpp"
#include "src/sim/solver/stage_solver.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

void validate(const StepperOptions& options) {
  require_positive("residual", options.residual, " m/s");
  if (options.max_iterations == 0) {
    throw std::invalid_argument("max_iterations is 0, it must be at least 1");
  }
}

[[noreturn]] void refuse_state(const Rods& rods, std::size_t node, const char* what,
                               const Eigen::RowVectorXd& value) {
  const auto after = std::upper_bound(rods.offsets.begin(), rods.offsets.end(), node);
  const auto rod = static_cast<std::size_t>(after - rods.offsets.begin()) - 1;
  std::ostringstream error;
  error << "the step diverges: node " << node - rods.offsets[rod] << " of rod " << rod
        << " has the " << what << " (" << value << "), which is not finite";
  throw std::runtime_error(error.str());
}

/// The weighted sum of two states, of all that they have.
void combine(const std::array<WeightedState, 2>& states, RodState& sum) {
  const WeightedState& first = states.front();
  const WeightedState& second = states.back();
  const auto add = [&](auto RodState::*part) {
    const auto& values = first.state->*part;
    const auto& others = second.state->*part;
    auto& sums = sum.*part;
    sums.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      sums[i] = first.weight * values[i] + second.weight * others[i];
    }
  };
  add(&RodState::positions);
  add(&RodState::velocities);
  add(&RodState::angles);
  add(&RodState::spins);
}

/// [J]
double kinetic_energy(const Rods& rods) {
  double energy = 0.0;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    add_kinetic_energy(rods, rod, energy);
  }
  return energy;
}

bool is_at(const RodState& rods, const RodState& state) {
  return rods.positions == state.positions && rods.velocities == state.velocities &&
         rods.angles == state.angles && rods.spins == state.spins;
}

}  // namespace

void require_finite(const Rods& rods) {
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    if (!rods.positions[i].allFinite()) {
      refuse_state(rods, i, "position", rods.positions[i].transpose());
    }
    if (!rods.velocities[i].allFinite()) {
      refuse_state(rods, i, "velocity", rods.velocities[i].transpose());
    }
  }
  for (std::size_t i = 0; i < rods.angles.size(); ++i) {
    const Eigen::RowVector2d turn(rods.angles[i], rods.spins[i]);
    if (!turn.allFinite()) {
      refuse_state(rods, i, "angle and spin", turn);
    }
  }
}

Stepper::Stepper(Rods rods, Effects effects, const StepperOptions& options,
                 std::unique_ptr<Contacts> contacts, std::unique_ptr<Joints> joints)
    : rods_(std::move(rods)),
      effects_(std::move(effects)),
      options_(options),
      contacts_(std::move(contacts)),
      joints_(std::move(joints)) {
  validate(options);
  solver_ = std::make_unique<StageSolver>(rods_, options, contacts_.get(), joints_.get());
}

Stepper::~Stepper() = default;

void Stepper::take_state(const Stepper& other) {
  assert(effects_.size() == other.effects_.size());
  rods_ = other.rods_;
  time_ = other.time_;
  report_ = other.report_;
  history_ = other.history_;
  for (std::size_t i = 0; i < effects_.size(); ++i) {
    effects_[i]->take_state(*other.effects_[i]);
  }
  if (joints_ != nullptr) {
    joints_->take_state(*other.joints_);
  }
  if (ObstacleMotions* const obstacles = moving_obstacles()) {
    obstacles->take_state(*other.moving_obstacles());
  }
  solver_->take_state(*other.solver_);
}

void Stepper::step(double length) {
  if (!(std::isfinite(length) && length > 0.0)) {
    throw std::invalid_argument("the length of a step is " + std::to_string(length) +
                                " s, it must be positive and finite");
  }
  require_finite(rods_);
  report_ = StepReport{};
  if (joints_ != nullptr) {
    joints_->unite(rods_);
  }
  if (ObstacleMotions* const obstacles = moving_obstacles()) {
    obstacles->begin_step(time_);
  }
  const double before = kinetic_energy(rods_) + solver_->anchor_energy();
  if (options_.integrator == Integrator::IMPLICIT_EULER) {
    solver_->solve(rods_, effects_, {time_, length}, nullptr);
    solver_->add_to(report_);
  } else {
    step_by_bdf2(length);
  }
  solver_->end_step(rods_);
  for (const auto& effect : effects_) {
    effect->end_step(rods_, {time_, length});
  }
  if (joints_ != nullptr) {
    joints_->end_step(rods_);
  }
  require_finite(rods_);
  report_.energy_gain += kinetic_energy(rods_) + solver_->anchor_energy() - before;
  time_ += length;
  has_step_ = true;
}

/// A step with an impact, and the one after it, are of implicit Euler: velocities jump in an
/// impact, and what is extrapolated from before leads through it.
void Stepper::step_by_bdf2(double length) {
  const bool is_at_history = history_.length > 0.0 && is_at(rods_, history_.after);
  history_.begin = rods_.state();
  if (!is_at_history) {
    report_.is_first_order = !is_solved_by_sdirk2(length);
  } else {
    report_.is_first_order = history_.has_impacts || !is_solved_by_bdf2(length);
  }
  if (report_.is_first_order) {
    rods_.state() = history_.begin;
    if (ObstacleMotions* const obstacles = moving_obstacles()) {
      obstacles->restore();
    }
    solver_->solve(rods_, effects_, {time_, length}, nullptr);
  }
  solver_->add_to(report_);
  history_.has_impacts = solver_->has_impacts();
  std::swap(history_.before, history_.begin);
  history_.after = rods_.state();
  history_.length = length;
}

/// With the ratio w of this step to the last one, x' = ((1 + w)² x₁ − w² x₀) / (1 + 2w) and v'
/// alike, it is a step of implicit Euler of (1 + w) / (1 + 2w) of its length from there.
/// @returns false if there are impacts
bool Stepper::is_solved_by_bdf2(double length) {
  const double ratio = length / history_.length;
  const double share = 1.0 / (1.0 + 2.0 * ratio);
  const double stage = (1.0 + ratio) * share * length;
  const TimeStep step{time_ + length - stage,
                      stage,
                      {{{&history_.begin, (1.0 + ratio) * (1.0 + ratio) * share},
                        {&history_.before, -ratio * ratio * share}}}};
  combine(step.earlier, history_.reference);
  solver_->solve(rods_, effects_, step, &history_.reference);
  return !solver_->has_impacts();
}

/// There are two stages, each of γ = 1 − 1/√2 of the step. The first ends at γ, the second at the
/// end of the step: its rates are measured from where those of the first lead in the rest of the
/// step.
/// @returns false if there are impacts
bool Stepper::is_solved_by_sdirk2(double length) {
  const double stage = (1.0 - std::sqrt(0.5)) * length;
  const double rest = length - stage;
  solver_->solve(rods_, effects_, {time_, stage}, nullptr);
  if (solver_->has_impacts()) {
    return false;
  }
  StepReport first;
  solver_->add_to(first);
  const double part = rest / stage;
  history_.after = rods_.state();
  const TimeStep second{
      time_ + rest, stage, {{{&history_.begin, 1.0 - part}, {&history_.after, part}}}};
  combine(second.earlier, history_.reference);
  solver_->solve(rods_, effects_, second, &history_.reference);
  if (solver_->has_impacts()) {
    return false;
  }
  report_ = first;
  return true;
}

ObstacleMotions* Stepper::moving_obstacles() const {
  return contacts_ != nullptr ? contacts_->motions() : nullptr;
}

bool Stepper::takes_moving_obstacles() const {
  return contacts_ != nullptr && contacts_->possible_motions() != nullptr;
}

void Stepper::add_obstacle(MovingObstacle obstacle) {
  if (!takes_moving_obstacles()) {
    throw std::invalid_argument("nothing would touch an obstacle: there are no contacts with any");
  }
  contacts_->possible_motions()->add(std::move(obstacle), time_);
  solver_->expect_pressed_contacts();
  has_step_ = false;
}

void Stepper::remove_obstacle(std::uint32_t obstacle) {
  if (moving_obstacles() == nullptr) {
    throw std::invalid_argument("there are no obstacles that move");
  }
  ObstacleMotions& obstacles = *moving_obstacles();
  obstacles.remove(obstacle);
  solver_->remove_object(obstacles.first_index() + obstacle);
  has_step_ = false;
}

RodForces Stepper::forces() const {
  RodForces forces;
  forces.tensions.assign(rods_.positions.size(), 0.0);
  forces.bending_moments.assign(rods_.positions.size(), Vector3d::Zero());
  forces.twisting_moments.assign(rods_.positions.size(), 0.0);
  if (has_step_) {
    solver_->add_forces(rods_, effects_, forces);
  }
  return forces;
}

double Stepper::energy() {
  return kinetic_energy(rods_) + solver_->anchor_energy() +
         (has_step_ ? solver_->stored_energy(rods_, effects_) : 0.0);
}

}  // namespace fiber
