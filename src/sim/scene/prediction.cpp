#include "fiber_proximity/sim/scene/prediction.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/prediction_observer.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

[[noreturn]] void refuse(const std::string& problem) { throw std::invalid_argument(problem); }

bool is_unit(const Vector3d& vector) { return std::abs(vector.norm() - 1.0) < 1e-6; }

/// @param before the time of the entry before, if there is one [s]
void require_later(double time, std::optional<double> before) {
  if (!(std::isfinite(time) && (before ? time > *before : time >= 0.0))) {
    refuse(format("time is ", time, " s, times must be finite and rise from 0",
                  before ? format(", the one before is ", *before, " s") : ""));
  }
}

void require_speed(double way, double duration) {
  if (way > max_speed * duration) {
    refuse(
        format("it goes ", way, " m in ", duration, " s, at most ", max_speed, " m/s are allowed"));
  }
}

/// The whole path in the time of the scene, from where the hold is now.
PlacementPath path_from_now(const SimScene& scene, const HoldTrajectory& trajectory) {
  const PlacementPath& path = trajectory.path;
  if (path.empty()) {
    refuse("it has no entries");
  }
  const Rods& rods = scene.stepper->rods();
  const double now = scene.stepper->time();
  PlacementPath whole{{now, placement_now(scene, trajectory.rod, trajectory.node)}};
  // The first state may be off by as much as a hold may be moved within a step, and as a hold in a
  // scene may be off its node.
  const double max_gap = std::max(
      std::min(pull_speed(rods.sections[trajectory.rod], scene.max_strain) * scene.step_length(),
               rods.rest_lengths[std::min(rods.first(trajectory.rod) + trajectory.node,
                                          rods.end(trajectory.rod) - 2)]),
      1e-6);
  for (std::size_t i = 0; i < path.size(); ++i) {
    with_context("entry " + std::to_string(i), [&] {
      const auto& [time, placement] = path[i];
      require_later(time, i == 0 ? std::nullopt : std::optional(path[i - 1].first));
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
      } else {
        require_speed(way, duration);
      }
      whole.emplace_back(now + time, placement);
    });
  }
  return whole;
}

/// The whole path in the time of the scene, from where the obstacle is now.
ObstaclePath path_from_now(const SimScene& scene, const ObstacleTrajectory& trajectory) {
  constexpr double max_gap = 1e-3;  // [m] by which frames and what follows them differ
  const ObstaclePath& path = trajectory.path;
  if (path.empty()) {
    refuse("it has no entries");
  }
  const double now = scene.stepper->time();
  ObstaclePath whole{{now, scene.motions()->poses()[trajectory.obstacle]}};
  for (std::size_t i = 0; i < path.size(); ++i) {
    with_context("entry " + std::to_string(i), [&] {
      const auto& [time, pose] = path[i];
      require_later(time, i == 0 ? std::nullopt : std::optional(path[i - 1].first));
      if (!pose.matrix().allFinite()) {
        refuse("its pose must be finite");
      }
      const double way = (pose.translation() - whole.back().second.translation()).norm();
      if (i == 0 && time == 0.0) {
        if (way > max_gap) {
          refuse(format("it begins ", way, " m from where the obstacle is, at time 0; ", max_gap,
                        " m are allowed"));
        }
        return;
      }
      require_speed(way, now + time - whole.back().first);
      whole.emplace_back(now + time, pose);
    });
  }
  return whole;
}

}  // namespace

Placement placement_now(const SimScene& scene, std::uint32_t rod, std::uint32_t node) {
  if (rod >= scene.stepper->rods().count()) {
    refuse(format("there is no fibre ", rod));
  }
  const NodeOfRod place = find_node(scene, rod, node);
  if (const auto id = scene.attachment->find(place.rod, place.node)) {
    return scene.attachment->placement(*id, scene.stepper->time());
  }
  return {position_of(scene.stepper->rods(), place), Vector3d::UnitX(), Vector3d::UnitY()};
}

void follow(SimScene& scene, const std::vector<HoldTrajectory>& trajectories) {
  if (trajectories.empty()) {
    return;
  }
  std::set<std::pair<std::uint32_t, std::uint32_t>> nodes;
  std::vector<std::shared_ptr<const PlacementPath>> paths;
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    const HoldTrajectory& trajectory = trajectories[i];
    with_context("trajectory " + std::to_string(i), [&] {
      placement_now(scene, trajectory.rod, trajectory.node);  // throws
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

void follow(SimScene& scene, const std::vector<ObstacleTrajectory>& trajectories) {
  std::set<std::uint32_t> obstacles;
  std::vector<std::shared_ptr<const ObstaclePath>> paths;
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    const std::uint32_t obstacle = trajectories[i].obstacle;
    with_context("trajectory " + std::to_string(i), [&] {
      if (scene.motions() == nullptr || obstacle >= scene.motions()->obstacles().size()) {
        refuse(format("there is no obstacle ", obstacle, " that moves"));
      }
      if (!obstacles.insert(obstacle).second) {
        refuse(format("obstacle ", quote(scene.motions()->obstacles()[obstacle].object.name),
                      " has another one already"));
      }
      paths.push_back(std::make_shared<const ObstaclePath>(path_from_now(scene, trajectories[i])));
    });
  }
  for (std::size_t i = 0; i < trajectories.size(); ++i) {
    scene.stepper->moving_obstacles()->redirect(
        trajectories[i].obstacle, [path = paths[i]](double time) { return pose_at(*path, time); });
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
      if (options.sample_period > 0.0) {
        const double taken = std::floor(observer.time() * (1.0 + 1e-9) / options.sample_period);
        next_sample = (taken + 1.0) * options.sample_period;
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
    observer.keep_warnings();
    observer.look();
  }
  return observer.take();
}

}  // namespace fiber
