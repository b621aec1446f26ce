#include "fiber_proximity/sim/scene/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/sim/joints.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double max_speed = 1000.0;  // [m/s]

/// The bodies of a pair: whether the second one is an object, then the two.
using Bodies = std::tuple<bool, std::uint32_t, std::uint32_t>;

[[noreturn]] void refuse(const std::string& problem) { throw std::invalid_argument(problem); }

bool is_unit(const Vector3d& vector) { return std::abs(vector.norm() - 1.0) < 1e-6; }

/// Where the hold of a node has it now, or where the node is if nothing holds it.
Placement placement_now(const SimScene& scene, const HoldTrajectory& trajectory) {
  const Rods& rods = scene.stepper->rods();
  const auto id = scene.attachment->find(trajectory.rod, trajectory.node);
  if (id) {
    return scene.attachment->placement(*id, scene.stepper->time());
  }
  return {position_of(rods, {trajectory.rod, trajectory.node}), Vector3d::UnitX(),
          Vector3d::UnitY()};
}

/// The whole path in the time of the scene, from where the hold is now.
PlacementPath path_from_now(const SimScene& scene, const HoldTrajectory& trajectory) {
  const PlacementPath& path = trajectory.path;
  if (path.empty()) {
    refuse("it has no entries");
  }
  const Rods& rods = scene.stepper->rods();
  const double now = scene.stepper->time();
  PlacementPath whole{{now, placement_now(scene, trajectory)}};
  // What is at time 0 may be off by as much as a hold may be moved within a step.
  const double max_gap = std::max(
      pull_speed(rods.sections[trajectory.rod], scene.max_strain) * scene.step_length(), 1e-6);
  for (std::size_t i = 0; i < path.size(); ++i) {
    with_context("entry " + std::to_string(i), [&] {
      const auto& [time, placement] = path[i];
      const double before = i == 0 ? 0.0 : path[i - 1].first;
      if (!(std::isfinite(time) && (i == 0 ? time >= 0.0 : time > before))) {
        refuse(format("time is ", time, " s, times must be finite and rise from 0",
                      i == 0 ? "" : format(", the one before is ", before, " s")));
      }
      if (!placement.position.allFinite() || !is_unit(placement.tangent) ||
          !is_unit(placement.director) ||
          std::abs(placement.tangent.dot(placement.director)) > 1e-6) {
        refuse("position must be finite, tangent and director of unit length, across each other");
      }
      const double way = (placement.position - whole.back().second.position).norm();
      const double duration = now + time - whole.back().first;
      if (i == 0 && time == 0.0) {
        if (way > max_gap) {
          refuse(format("it begins ", way, " m from where the node is held, at time 0; ", max_gap,
                        " m are allowed"));
        }
        whole.clear();
      } else if (way > max_speed * duration) {
        refuse(format("it goes ", way, " m in ", duration, " s, at most ", max_speed,
                      " m/s are allowed"));
      }
      whole.emplace_back(now + time, placement);
    });
  }
  return whole;
}

/// Collects what happens.
class Observer {
 public:
  Observer(const SimScene& scene, const PredictionOptions& options)
      : scene_(scene), begin_(scene.stepper->time()), engine_(make_engine("run_tree")) {
    query_.type = QueryType::FIBER_PAIRS;
    query_.margin = options.margin;
    const Rods& rods = scene.stepper->rods();
    fibers_ = assembly_of(rods);
    prediction_.tensions.resize(rods.count());
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      prediction_.tensions[rod].rod = rod;
    }
  }

  double time() const { return scene_.stepper->time() - begin_; }

  void look() {
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

  /// To be called after each frame: before the first one the last step is that of the running
  /// scene.
  void count_unbalanced() {
    prediction_.unbalanced_frames += scene_.stepper->report().unbalanced > 0 ? 1 : 0;
  }

  void sample() { prediction_.samples.push_back({time(), scene_.stepper->rods().positions}); }

  Prediction take() {
    for (auto& [bodies, clearance] : clearances_) {
      prediction_.clearances.push_back(clearance);
    }
    for (auto& [bodies, touch] : touches_) {
      prediction_.touches.push_back(touch);
    }
    for (auto& [node, hold] : holds_) {
      prediction_.holds.push_back(hold);
    }
    return std::move(prediction_);
  }

  void stop(const std::string& problem) { prediction_.problem = problem; }

 private:
  void add_clearances(bool is_object) {
    for (const Contact& contact : result_.contacts) {
      const Bodies bodies(is_object, contact.fiber_a, contact.fiber_b);
      const auto [place, is_new] =
          clearances_.try_emplace(bodies, PredictedClearance{is_object, contact, time()});
      if (!is_new && contact.distance < place->second.contact.distance) {
        place->second = {is_object, contact, time()};
      }
    }
  }

  void add_forces(const RodForces& forces) {
    const Rods& rods = scene_.stepper->rods();
    for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
      for (std::uint32_t edge = rods.first(rod); edge + 1 < rods.end(rod); ++edge) {
        keep_greater({rod, edge - rods.first(rod),
                      forces.tensions.empty() ? 0.0 : forces.tensions[edge], time()},
                     prediction_.tensions[rod]);
      }
    }
    for (const RodForces::HoldForce& hold : forces.holds) {
      const GreatestForce now{hold.rod, hold.node, hold.force.norm(), time()};
      keep_greater(now, holds_.try_emplace({hold.rod, hold.node}, now).first->second);
    }
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

  void add_touch(const Bodies& bodies, double force) {
    const auto& [is_object, rod, other] = bodies;
    PredictedTouch& touch =
        touches_
            .try_emplace(bodies, PredictedTouch{rod, is_object, other, time(), time(), 0.0, 0.0})
            .first->second;
    touch.last = time();
    if (force > touch.max_force) {
      touch.max_force = force;
      touch.time_of_max = time();
    }
  }

  static void keep_greater(const GreatestForce& force, GreatestForce& greatest) {
    if (force.force > greatest.force) {
      greatest = force;
    }
  }

  const SimScene& scene_;
  const double begin_;  // [s]
  std::unique_ptr<ProximityEngine> engine_;
  FiberAssembly fibers_;
  QueryOptions query_;
  QueryResult result_;
  Prediction prediction_;
  std::map<Bodies, PredictedClearance> clearances_;
  std::map<Bodies, PredictedTouch> touches_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, GreatestForce> holds_;
};

void validate(const PredictionOptions& options) {
  if (!(options.duration > 0.0 && options.duration <= PredictionOptions::max_duration)) {
    refuse(format("duration is ", options.duration, " s, it must be more than 0 and at most ",
                  PredictionOptions::max_duration));
  }
  if (!(options.sample_period >= 0.0 && std::isfinite(options.sample_period))) {
    refuse(
        format("sample_period is ", options.sample_period, " s, it must be finite and at least 0"));
  }
  if (!(options.margin >= 0.0 && std::isfinite(options.margin))) {
    refuse(format("margin is ", options.margin, " m, it must be finite and at least 0"));
  }
}

}  // namespace

void follow(SimScene& scene, const std::vector<HoldTrajectory>& trajectories) {
  if (trajectories.empty()) {
    return;
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> nodes;
  std::vector<std::shared_ptr<const PlacementPath>> paths;
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    const HoldTrajectory& trajectory = trajectories[i];
    with_context("trajectory " + std::to_string(i), [&] {
      if (trajectory.rod >= scene.stepper->rods().count()) {
        refuse(format("there is no fibre ", trajectory.rod));
      }
      find_node(scene, trajectory.rod, trajectory.node);
      if (!nodes.emplace(trajectory.rod, trajectory.node).second) {
        refuse(format("node ", trajectory.node, " of fibre ",
                      quote(scene.fiber_names[trajectory.rod]), " has another one already"));
      }
      paths.push_back(std::make_shared<const PlacementPath>(path_from_now(scene, trajectory)));
    });
  }
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    const auto& [rod, node, path] = trajectories[i];
    if (const auto id = scene.attachment->find(rod, node)) {
      scene.attachment->redirect(
          *id, [path = paths[i]](double time) { return placement_at(*path, time); });
      scene.paths[*id] = paths[i];
    } else {
      hold_on_path(scene, {rod, node}, paths[i]);
    }
  }
}

Prediction predict(SimScene& scene, const PredictionOptions& options,
                   const std::function<bool()>& is_cancelled) {
  validate(options);
  Observer observer(scene, options);
  const auto frames =
      static_cast<std::int64_t>(std::ceil(options.duration / scene.time_step * (1.0 - 1e-9)));
  double next_sample = options.sample_period > 0.0 ? 0.0 : options.duration;
  observer.look();
  for (std::int64_t frame = 0; frame <= frames; ++frame) {
    if (observer.time() >= next_sample * (1.0 - 1e-9) || frame == frames) {
      observer.sample();
      while (options.sample_period > 0.0 && next_sample <= observer.time() * (1.0 + 1e-9)) {
        next_sample += options.sample_period;
      }
    }
    if (frame == frames) {
      break;
    }
    if (is_cancelled()) {
      observer.stop("it was cancelled");
      break;
    }
    try {
      scene.advance();
    } catch (const std::runtime_error& error) {
      observer.stop(error.what());
      break;
    }
    observer.count_unbalanced();
    observer.look();
  }
  return observer.take();
}

}  // namespace fiber
