#include "fiber_proximity/sim/scene/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/prediction_observer.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double max_speed = 1000.0;  // [m/s]

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
  PredictionObserver observer(scene, options);
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
