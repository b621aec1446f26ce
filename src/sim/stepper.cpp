#include "fiber_proximity/sim/stepper.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>
#include <string>

#include "energy_guard.hpp"
#include "fiber_proximity/query/threads.hpp"
#include "rod_group.hpp"

namespace fiber {
namespace {

void validate(const StepperOptions& options, bool has_contacts) {
  if (options.iterations == 0) {
    throw std::invalid_argument("iterations is 0, it must be at least 1");
  }
  if (!(std::isfinite(options.tolerance) && options.tolerance >= 0.0)) {
    throw std::invalid_argument("tolerance is " + std::to_string(options.tolerance) +
                                " m, it must be at least 0 and finite");
  }
  if (has_contacts && options.integrator == Integrator::IMPLICIT_MIDPOINT) {
    throw std::invalid_argument(
        "the integrator is implicit midpoint, it must be implicit Euler where there are contacts");
  }
}

/// Implicit midpoint is a step of implicit Euler to the middle, continued in a straight line.
void continue_from_middle(Rods& rods, const EnergyGuard::Motion& beginning, double half_step) {
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    rods.positions[i] += half_step * rods.velocities[i];
    rods.velocities[i] = 2.0 * rods.velocities[i] - beginning.velocities[i];
  }
  for (std::size_t i = 0; i < rods.spins.size(); ++i) {
    rods.angles[i] += half_step * rods.spins[i];
    rods.spins[i] = 2.0 * rods.spins[i] - beginning.spins[i];
  }
}

/// Rods of equal sizes, as many together as can be moved side by side.
Batches side_by_side(const Rods& rods, const std::vector<std::uint32_t>& which) {
  Batches parts;
  std::map<std::uint32_t, std::size_t> open;  // parts, by node count
  for (const std::uint32_t rod : which) {
    const auto [found, is_new] = open.try_emplace(rods.node_count(rod), parts.size());
    if (is_new || parts[found->second].size() == lane_count) {
      found->second = parts.size();
      parts.emplace_back();
    }
    parts[found->second].push_back(rod);
  }
  return parts;
}

/// What is moved independently: everything together where there are contacts, else batch by batch.
std::vector<Batches> independent_parts(const Rods& rods, const std::vector<std::uint32_t>& which,
                                       bool has_contacts) {
  const Batches batches = side_by_side(rods, which);
  std::vector<Batches> parts;
  if (has_contacts && !batches.empty()) {
    return {batches};
  }
  for (const std::vector<std::uint32_t>& batch : batches) {
    parts.push_back({batch});
  }
  return parts;
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

/// Who moves which rods. Nothing but memory stays with a worker from one step to the next, so that
/// there need not be more of them than threads.
struct Stepper::Workers {
  Workers(const StepperOptions& options, Contacts* contacts)
      : arena(arena_concurrency(options.threads)),
        groups([contacts] { return RodGroup(contacts); }) {}

  tbb::task_arena arena;
  std::vector<Batches> parts;  // that are moved independently
  tbb::enumerable_thread_specific<RodGroup> groups;
};

Stepper::Stepper(Rods rods, std::vector<std::unique_ptr<Effect>> effects,
                 const StepperOptions& options, std::unique_ptr<Contacts> contacts)
    : rods_(std::move(rods)),
      effects_(std::move(effects)),
      options_(options),
      contacts_(std::move(contacts)) {
  validate(options, contacts_ != nullptr);
  workers_ = std::make_unique<Workers>(options, contacts_.get());
  std::vector<std::uint32_t> all(rods_.count());
  std::iota(all.begin(), all.end(), 0U);
  workers_->parts = independent_parts(rods_, all, contacts_ != nullptr);
  if (options.integrator == Integrator::IMPLICIT_MIDPOINT) {
    guard_ = std::make_unique<EnergyGuard>(rods_.count());
  }
}

Stepper::~Stepper() = default;

void Stepper::step(double length) {
  if (!(std::isfinite(length) && length > 0.0)) {
    throw std::invalid_argument("the length of a step is " + std::to_string(length) +
                                " s, it must be positive and finite");
  }
  if (guard_ != nullptr) {
    step_by_midpoint(length);
  } else {
    begin({time_, length});
    solve(workers_->parts, length, Gains::TAKEN);
  }
  for (const std::unique_ptr<Effect>& effect : effects_) {
    effect->end_step(rods_, {time_, length});
  }
  require_finite(rods_);
  time_ += length;
}

void Stepper::step_by_midpoint(double length) {
  begin({time_, 0.5 * length});
  guard_->begin(rods_, effects_);
  solve(workers_->parts, 0.5 * length, Gains::LEFT);
  continue_from_middle(rods_, guard_->beginning(), 0.5 * length);
  const std::vector<std::uint32_t> gained = guard_->bring_back_gained(rods_, effects_);
  if (!gained.empty()) {
    begin({time_, length});
    solve(independent_parts(rods_, gained, false), length, Gains::TAKEN);
    guard_->accept_again(gained, rods_, effects_);
  }
}

void Stepper::begin(const TimeStep& step) {
  workers_->arena.execute([&] {
    for (const std::unique_ptr<Effect>& effect : effects_) {
      effect->begin_step(rods_, step);
    }
    if (contacts_ != nullptr) {
      contacts_->begin_step(rods_, step);
    }
  });
}

void Stepper::solve(const std::vector<Batches>& parts, double length, Gains gains) {
  workers_->arena.execute([&] {
    tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t part) {
      RodGroup& group = workers_->groups.local();
      group.assign(rods_, parts[part]);
      group.solve(rods_, effects_, options_, length, gains);
    });
  });
}

}  // namespace fiber
