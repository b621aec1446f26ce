#include "src/sim/scene/obstacle_motion.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/times.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber {

using Eigen::Isometry3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

constexpr double unit_tolerance = 1e-3;
constexpr double far_away = 1e6;  // [m]

Quaterniond read_orientation(const YamlField& field) {
  const std::vector<double> numbers = field.numbers(4);
  const Quaterniond orientation(numbers.data());
  if (!(std::abs(orientation.norm() - 1.0) < unit_tolerance)) {
    field.refuse("a quaternion x y z w of length 1");
  }
  return orientation.normalized();
}

void read_obstacle_waypoint(const YamlField& entry, SimObstacleWaypoint& waypoint) {
  entry.read("position", waypoint.position);
  if (!waypoint.position.allFinite()) {
    entry.get("position").refuse("finite");
  }
  if (const auto orientation = entry.find("orientation")) {
    waypoint.orientation = read_orientation(*orientation);
  }
  if (const auto angle = entry.find("angle")) {
    waypoint.angle = angle->number();
    if (!std::isfinite(waypoint.angle)) {
      angle->refuse("finite");
    }
  }
}

}  // namespace

double reach_of(const EnvironmentObject& object) {
  double farthest = 0.0;
  for (const PlacedShape& placed : object.shapes) {
    farthest = std::max(farthest, placed.pose.translation().norm() + reach(placed.shape));
  }
  return farthest;
}

void require_slow_turns(const SimDescription& scene) {
  constexpr double max_turn = 3.0;  // [rad] less than half a turn
  const double step = scene.time_step / scene.substeps;
  for (const SimMovingObstacle& obstacle : scene.moving_obstacles) {
    for (std::size_t i = 1; i < obstacle.path.size(); ++i) {
      const SimObstacleWaypoint& from = obstacle.path[i - 1];
      const SimObstacleWaypoint& to = obstacle.path[i];
      const double turn = std::abs(to.angle - from.angle) / (to.time - from.time) * step;
      if (!(turn <= max_turn)) {
        throw std::invalid_argument(format(obstacle.place, " turns by ", turn, " rad in a step of ",
                                           step, " s, it must be at most ", max_turn,
                                           " rad: more substeps, or slower"));
      }
    }
  }
}

namespace {

/// @throws std::invalid_argument naming the obstacle's fastest way if that is too fast
void require_slow(const SimMovingObstacle& obstacle) {
  const double far = reach_of(obstacle.object);
  for (std::size_t i = 1; i < obstacle.path.size(); ++i) {
    const SimObstacleWaypoint& from = obstacle.path[i - 1];
    const SimObstacleWaypoint& to = obstacle.path[i];
    const double turn =
        from.orientation.angularDistance(to.orientation) + std::abs(to.angle - from.angle);
    const double speed =
        ((to.position - from.position).norm() + far * turn) / (to.time - from.time);
    if (!(speed <= max_speed)) {
      throw std::invalid_argument(obstacle.place + " moves with " + std::to_string(speed) +
                                  " m/s from " + std::to_string(from.time) + " s to " +
                                  std::to_string(to.time) + " s, it must be at most " +
                                  std::to_string(max_speed) + " m/s");
    }
  }
}

Isometry3d pose_of(const SimObstacleWaypoint& waypoint, const Vector3d& axis) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = waypoint.position;
  pose.linear() =
      (waypoint.orientation * Eigen::AngleAxisd(waypoint.angle, axis)).toRotationMatrix();
  return pose;
}

}  // namespace

SimMovingObstacle read_obstacle_motion(const SceneObstacle& read) {
  SimMovingObstacle obstacle;
  obstacle.place = read.place;
  obstacle.object = read.object;
  const SimObstacleWaypoint beginning{0.0, read.object.pose.translation(),
                                      Quaterniond(read.object.pose.linear()), 0.0};
  if (read.link) {
    obstacle.frame = read.link;
    obstacle.path = {beginning};
    return obstacle;
  }
  const YamlField& motion = *read.motion;
  motion.require_map(key_names("obstacle motion"));
  const auto path = motion.find("path");
  const auto frame = motion.find("frame");
  const auto period = motion.find("period");
  if (path.has_value() == frame.has_value()) {
    motion.refuse("a map with either a path or a frame");
  }
  if (period && !path) {
    period->refuse("absent where there is no path");
  }
  if (const auto axis = motion.find("axis")) {
    obstacle.axis = axis->vector();
    if (!obstacle.axis.allFinite() || !(obstacle.axis.norm() > 1e-9)) {
      axis->refuse("a direction");
    }
    obstacle.axis.normalize();
  }
  if (frame) {
    obstacle.frame = frame->text();
    obstacle.path = {beginning};
    return obstacle;
  }
  obstacle.path = read_entries(*path, "path", key_names("obstacle waypoint"), beginning,
                               read_obstacle_waypoint);
  obstacle.is_periodic = period.has_value();
  if (period) {
    close_entries(*period, "path", obstacle.path);
  }
  require_slow(obstacle);
  obstacle.object.pose = obstacle.pose_at(0.0);
  return obstacle;
}

Isometry3d SimMovingObstacle::pose_at(double time) const {
  const double last = path.back().time;
  const double at = is_periodic && last > 0.0 ? std::fmod(time, last) : time;
  const auto later = std::find_if(path.begin(), path.end(),
                                  [at](const SimObstacleWaypoint& each) { return each.time > at; });
  if (later == path.end()) {
    return pose_of(path.back(), axis);
  }
  const SimObstacleWaypoint& from = *std::prev(later);
  const double share = (at - from.time) / (later->time - from.time);
  return pose_of({at, from.position + share * (later->position - from.position),
                  from.orientation.slerp(share, later->orientation),
                  from.angle + share * (later->angle - from.angle)},
                 axis);
}

Isometry3d pose_at(const ObstaclePath& path, double time) {
  const auto later = std::find_if(path.begin(), path.end(),
                                  [time](const auto& entry) { return entry.first > time; });
  if (later == path.begin() || later == path.end()) {
    return later == path.end() ? path.back().second : later->second;
  }
  const auto& [start, from] = *std::prev(later);
  const double share = (time - start) / (later->first - start);
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() =
      from.translation() + share * (later->second.translation() - from.translation());
  pose.linear() = Quaterniond(from.linear())
                      .slerp(share, Quaterniond(later->second.linear()))
                      .normalized()
                      .toRotationMatrix();
  return pose;
}

std::shared_ptr<ObstacleMotions> make_obstacle_motions(const SimDescription& description,
                                                       SimScene& scene) {
  std::vector<MovingObstacle> obstacles;
  for (const SimMovingObstacle& obstacle : description.moving_obstacles) {
    if (!obstacle.frame) {
      obstacles.push_back(
          {obstacle.object, [obstacle](double time) { return obstacle.pose_at(time); }});
      continue;
    }
    // Until its frame is known it is out of everybody's way.
    Isometry3d nowhere = obstacle.object.pose;
    nowhere.translation() += Vector3d::Constant(far_away);
    const auto path = std::make_shared<ObstaclePath>(ObstaclePath{{0.0, nowhere}});
    scene.obstacle_frames.push_back({*obstacle.frame, static_cast<std::uint32_t>(obstacles.size()),
                                     obstacle.place, obstacle.object.pose, path});
    obstacles.push_back({obstacle.object, [path](double time) { return pose_at(*path, time); }});
  }
  return std::make_shared<ObstacleMotions>(
      std::move(obstacles), static_cast<std::uint32_t>(description.environment->objects().size()));
}

void copy_obstacle_frames(const SimScene& scene, SimScene& copy) {
  for (const FollowedObstacle& followed : scene.obstacle_frames) {
    const auto own = std::make_shared<const ObstaclePath>(*followed.path);
    copy.stepper->moving_obstacles()->redirect(followed.obstacle,
                                               [own](double time) { return pose_at(*own, time); });
  }
}

}  // namespace fiber
