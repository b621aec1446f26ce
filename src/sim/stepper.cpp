#include "fiber_proximity/sim/stepper.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "require.hpp"
#include "solver/stage_solver.hpp"

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

/// Where the second stage of SDIRK2 measures rates from: where a part of the step leads with what
/// the first stage, of the rest, has found there.
template <class Value>
void extrapolate(const std::vector<Value>& begun, const std::vector<Value>& begun_rates,
                 const std::vector<Value>& rates, double part, double rest,
                 std::vector<Value>& values, std::vector<Value>& new_rates) {
  values.resize(begun.size());
  new_rates.resize(begun.size());
  for (std::size_t i = 0; i < begun.size(); ++i) {
    values[i] = begun[i] + part * rates[i];
    new_rates[i] = begun_rates[i] + part / rest * (rates[i] - begun_rates[i]);
  }
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
                 std::unique_ptr<Contacts> contacts)
    : rods_(std::move(rods)),
      effects_(std::move(effects)),
      options_(options),
      contacts_(std::move(contacts)) {
  validate(options);
  solver_ = std::make_unique<StageSolver>(rods_, options, contacts_.get());
}

Stepper::~Stepper() = default;

void Stepper::step(double length) {
  if (!(std::isfinite(length) && length > 0.0)) {
    throw std::invalid_argument("the length of a step is " + std::to_string(length) +
                                " s, it must be positive and finite");
  }
  report_ = StepReport{};
  if (options_.integrator == Integrator::IMPLICIT_EULER) {
    solver_->solve(rods_, effects_, {time_, length}, nullptr);
    solver_->add_to(report_);
  } else {
    step_by_sdirk2(length);
  }
  for (const std::unique_ptr<Effect>& effect : effects_) {
    effect->end_step(rods_, {time_, length});
  }
  require_finite(rods_);
  time_ += length;
}

/// Alexander 1977, Eq. 3.1: of two stages of γ = 1 − 1/√2 of the step each, the first ends at γ,
/// the second at the end of the step.
void Stepper::step_by_sdirk2(double length) {
  const double stage = (1.0 - std::sqrt(0.5)) * length;
  const double rest = length - stage;
  const RodState begun = state_of(rods_);
  solver_->solve(rods_, effects_, {time_, stage}, nullptr);
  solver_->add_to(report_);
  RodState reference;
  extrapolate(begun.positions, begun.velocities, rods_.velocities, rest, stage, reference.positions,
              reference.velocities);
  extrapolate(begun.angles, begun.spins, rods_.spins, rest, stage, reference.angles,
              reference.spins);
  solver_->solve(rods_, effects_, {time_ + rest, stage}, &reference);
  solver_->add_to(report_);
}

RodForces Stepper::forces() const {
  RodForces forces;
  forces.tensions.assign(rods_.positions.size(), 0.0);
  forces.bending_moments.assign(rods_.positions.size(), Vector3d::Zero());
  forces.twisting_moments.assign(rods_.positions.size(), 0.0);
  if (time_ > 0.0) {
    solver_->add_forces(rods_, effects_, forces);
  }
  return forces;
}

double Stepper::energy() {
  double energy = time_ > 0.0 ? solver_->stored_energy(rods_, effects_) : 0.0;
  for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
    for (std::uint32_t i = rods_.first(rod); i < rods_.end(rod); ++i) {
      energy += 0.5 * rods_.masses[i] * rods_.velocities[i].squaredNorm();
      if (!rods_.spins.empty()) {
        const double inertia = rods_.sections[rod].inertia_per_length * rods_.rest_lengths[i];
        energy += 0.5 * inertia * rods_.spins[i] * rods_.spins[i];
      }
    }
  }
  return energy;
}

}  // namespace fiber
