#include "src/sim/scene/prediction_observer.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/sim/joints.hpp"
#include "src/sim/scene/parts.hpp"

namespace fiber {
namespace {

[[noreturn]] void refuse_option(const std::string& problem) {
  throw std::invalid_argument(problem);
}

void validate(const PredictionOptions& options) {
  if (!(options.duration > 0.0 && options.duration <= PredictionOptions::max_duration)) {
    refuse_option(format("duration is ", options.duration,
                         " s, it must be more than 0 and at most ",
                         PredictionOptions::max_duration));
  }
  if (!(options.sample_period >= 0.0 && std::isfinite(options.sample_period))) {
    refuse_option(
        format("sample_period is ", options.sample_period, " s, it must be finite and at least 0"));
  }
  if (!(options.margin >= 0.0 && std::isfinite(options.margin))) {
    refuse_option(format("margin is ", options.margin, " m, it must be finite and at least 0"));
  }
}

void keep_greater(const GreatestForce& force, GreatestForce& greatest) {
  if (force.force > greatest.force) {
    greatest = force;
  }
}

}  // namespace

PredictionObserver::PredictionObserver(const SimScene& scene, const PredictionOptions& options)
    : scene_(scene), begin_(scene.stepper->time()), engine_(make_engine("run_tree")) {
  validate(options);
  query_.type = QueryType::FIBER_PAIRS;
  query_.margin = options.margin;
  const Rods& rods = scene.stepper->rods();
  fibers_ = assembly_of(rods);
  prediction_.tensions.resize(rods.count());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    prediction_.tensions[rod].rod = rod;
  }
}

void PredictionObserver::look() {
  fibers_.update_points(scene_.stepper->rods().positions);
  engine_->update(fibers_);
  engine_->query(query_, result_);
  add_clearances(false);
  if (scene_.motions() == nullptr) {
    scene_.environment->query(fibers_, query_, {}, result_);
  } else {
    Environment(scene_.objects()).query(fibers_, query_, {}, result_);
  }
  add_clearances(true);
  add_forces(scene_.stepper->forces());
  prediction_.time = time();
}

void PredictionObserver::keep_warnings() {
  prediction_.unbalanced_frames += scene_.frame.unbalanced > 0 ? 1 : 0;
  for (SimWarning& warning : frame_warnings(scene_)) {
    if (!std::exchange(is_warned_[static_cast<std::size_t>(warning.kind)], true)) {
      prediction_.warnings.push_back({std::move(warning.text), time()});
    }
  }
}

void PredictionObserver::sample() {
  prediction_.samples.push_back({time(), scene_.stepper->rods().positions});
}

Prediction PredictionObserver::take() {
  for (auto& [bodies, clearance] : clearances_) {
    prediction_.clearances.push_back(clearance);
  }
  for (auto& [bodies, touch] : touches_) {
    prediction_.touches.push_back(touch);
  }
  for (auto& [node, hold] : holds_) {
    prediction_.holds.push_back(hold);
  }
  for (auto& [node, joint] : joints_) {
    prediction_.joints.push_back(joint);
  }
  return std::move(prediction_);
}

void PredictionObserver::add_clearances(bool is_object) {
  for (const Contact& contact : result_.contacts) {
    const Bodies bodies(is_object, contact.fiber_a, contact.fiber_b);
    const auto [place, is_new] =
        clearances_.try_emplace(bodies, PredictedClearance{is_object, contact, time()});
    if (!is_new && contact.distance < place->second.contact.distance) {
      place->second = {is_object, contact, time()};
    }
  }
}

void PredictionObserver::add_forces(const RodForces& forces) {
  const Rods& rods = scene_.stepper->rods();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t edge = rods.first(rod); edge + 1 < rods.end(rod); ++edge) {
      keep_greater({rod, edge - rods.first(rod),
                    forces.tensions.empty() ? 0.0 : forces.tensions[edge], time()},
                   prediction_.tensions[rod]);
    }
  }
  keep_greatest(forces.holds, holds_);
  keep_greatest(forces.joints, joints_);
  std::map<Bodies, double> sums;
  for (const RodForces::ContactForce& contact : forces.contacts) {
    const bool is_object = contact.other_rod == RodForces::ContactForce::obstacle;
    const std::uint32_t other = is_object ? contact.object : contact.other_rod;
    const Bodies bodies =
        is_object ? Bodies(true, contact.rod, other)
                  : Bodies(false, std::min(contact.rod, other), std::max(contact.rod, other));
    sums[bodies] += contact.normal_force.norm();
  }
  for (const auto& [bodies, force] : sums) {
    if (force > 0.0) {
      add_touch(bodies, force);
    }
  }
}

template <class Force>
void PredictionObserver::keep_greatest(const std::vector<Force>& forces,
                                       NodeForces& greatest) const {
  for (const Force& each : forces) {
    const GreatestForce now{each.rod, each.node, each.force.norm(), time()};
    keep_greater(now, greatest.try_emplace({each.rod, each.node}, now).first->second);
  }
}

void PredictionObserver::add_touch(const Bodies& bodies, double force) {
  const auto& [is_object, rod, other] = bodies;
  PredictedTouch& touch =
      touches_.try_emplace(bodies, PredictedTouch{rod, is_object, other, time(), time(), 0.0, 0.0})
          .first->second;
  touch.last = time();
  if (force > touch.max_force) {
    touch.max_force = force;
    touch.time_of_max = time();
  }
}

}  // namespace fiber
