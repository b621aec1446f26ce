#include "fiber_proximity/sim/stepper.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cmath>
#include <map>
#include <stdexcept>
#include <string>

#include "rod_group.hpp"

namespace fiber {
namespace {

void validate(const StepperOptions& options) {
  if (options.iterations == 0) {
    throw std::invalid_argument("iterations is 0, it must be at least 1");
  }
  if (!(std::isfinite(options.tolerance) && options.tolerance >= 0.0)) {
    throw std::invalid_argument("tolerance is " + std::to_string(options.tolerance) +
                                " m, it must be at least 0 and finite");
  }
}

/// Implicit midpoint is a step of implicit Euler to the middle, continued in a straight line.
/// @param contacts what this line must not lead through; null for nothing
void continue_from_middle(Rods& rods, const std::vector<Eigen::Vector3d>& old_velocities,
                          const std::vector<double>& old_spins, double half_step,
                          Contacts* contacts) {
  std::vector<Eigen::Vector3d> displacements = rods.velocities;
  for (Eigen::Vector3d& displacement : displacements) {
    displacement *= half_step;
  }
  if (contacts != nullptr) {
    contacts->measure(rods);
    contacts->limit(rods, displacements);
  }
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    rods.positions[i] += displacements[i];
    rods.velocities[i] = 2.0 * rods.velocities[i] - old_velocities[i];
  }
  for (std::size_t i = 0; i < rods.spins.size(); ++i) {
    rods.angles[i] += half_step * rods.spins[i];
    rods.spins[i] = 2.0 * rods.spins[i] - old_spins[i];
  }
}

/// Rods of equal sizes, as many together as can be moved side by side.
Batches rods_side_by_side(const Rods& rods) {
  Batches parts;
  std::map<std::uint32_t, std::size_t> open;  // parts, by node count
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const auto [found, is_new] = open.try_emplace(rods.node_count(rod), parts.size());
    if (is_new || parts[found->second].size() == lane_count) {
      found->second = parts.size();
      parts.emplace_back();
    }
    parts[found->second].push_back(rod);
  }
  return parts;
}

}  // namespace

/// Who moves which rods. Nothing but memory stays with a worker from one step to the next, so that
/// there need not be more of them than threads.
struct Stepper::Workers {
  Workers(const StepperOptions& options, Contacts* contacts)
      : arena(options.threads == 0 ? tbb::task_arena::automatic
                                   : static_cast<int>(options.threads)),
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
  validate(options);
  workers_ = std::make_unique<Workers>(options, contacts_.get());
  const Batches batches = rods_side_by_side(rods_);
  if (contacts_ == nullptr) {
    for (const std::vector<std::uint32_t>& batch : batches) {
      workers_->parts.push_back({batch});
    }
  } else if (!batches.empty()) {
    workers_->parts.push_back(batches);
  }
}

Stepper::~Stepper() = default;

void Stepper::step(double length) {
  if (!(std::isfinite(length) && length > 0.0)) {
    throw std::invalid_argument("the length of a step is " + std::to_string(length) +
                                " s, it must be positive and finite");
  }
  if (options_.integrator == Integrator::IMPLICIT_MIDPOINT) {
    const std::vector<Eigen::Vector3d> old_velocities = rods_.velocities;
    const std::vector<double> old_spins = rods_.spins;
    solve({time_, 0.5 * length});
    continue_from_middle(rods_, old_velocities, old_spins, 0.5 * length, contacts_.get());
  } else {
    solve({time_, length});
  }
  for (const std::unique_ptr<Effect>& effect : effects_) {
    effect->end_step(rods_, {time_, length});
  }
  time_ += length;
}

void Stepper::solve(const TimeStep& step) {
  workers_->arena.execute([&] {
    for (const std::unique_ptr<Effect>& effect : effects_) {
      effect->begin_step(rods_, step);
    }
    if (contacts_ != nullptr) {
      contacts_->begin_step(rods_, step);
    }
    tbb::parallel_for(std::size_t{0}, workers_->parts.size(), [&](std::size_t part) {
      RodGroup& group = workers_->groups.local();
      group.assign(rods_, workers_->parts[part]);
      group.solve(rods_, effects_, options_, step.length);
    });
  });
}

}  // namespace fiber
