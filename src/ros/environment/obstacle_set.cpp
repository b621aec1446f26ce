#include "src/ros/environment/obstacle_set.hpp"

#include <ros/console.h>

#include <exception>
#include <stdexcept>
#include <utility>

#include "src/ros/environment/obstacle_change.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using Changes = std::vector<fiber::ObjectChange>;
using Obstacles = std::vector<fiber_proximity::Obstacle>;
using Operation = fiber::ObjectChange::Operation;

std::size_t triangle_count(const Obstacles& obstacles) {
  std::size_t count = 0;
  for (const fiber_proximity::Obstacle& obstacle : obstacles) {
    for (const shape_msgs::Mesh& mesh : obstacle.meshes) {
      count += mesh.triangles.size();
    }
  }
  return count;
}

}  // namespace

void ObstacleSet::apply(const Changes& changes, const std::vector<ros::Time>& stamps,
                        const std::set<std::string>& cancelled, const std::string& owner) {
  const ros::Time now = ros::Time::now();
  std::map<std::string, std::string> owners = owners_;
  Changes steps;
  std::vector<ros::Time> step_stamps;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    const fiber::ObjectChange& change = changes[i];
    const std::string& name = change.object.name;
    if (change.operation == Operation::ADD) {
      const auto [there, is_new] = owners.try_emplace(name, owner);
      if (!is_new && there->second != owner) {
        throw std::invalid_argument(
            "obstacle " + fiber::quote(name) + " is there already, from " +
            (there->second.empty() ? "the scene or ~obstacles" : fiber::quote(there->second)) +
            ": its name must be another one");
      }
      steps.push_back(change);
    } else if (change.operation != Operation::REMOVE) {
      steps.push_back(change);
      owners.try_emplace(name, owner);
    } else if (name.empty()) {
      for (const auto& [present, its_owner] : std::exchange(owners, {})) {
        steps.push_back(removal_of(present));
      }
    } else if (owners.erase(name) > 0 || cancelled.count(name) == 0) {
      steps.push_back(change);
    }
    step_stamps.resize(steps.size(), stamps[i].isZero() ? now : stamps[i]);
  }
  hooks_.check(steps);
  world_.apply(steps);
  for (std::size_t i = 0; i < steps.size(); ++i) {
    hooks_.take(steps[i], step_stamps[i]);
  }
  owners_ = std::move(owners);
}

Change ObstacleSet::change_of(std::shared_ptr<const Obstacles> obstacles, double patience,
                              Worker& worker) {
  TouchedObjects touched;
  std::vector<FramedName> frames;
  for (const fiber_proximity::Obstacle& obstacle : *obstacles) {
    const bool removes = obstacle.operation == fiber_proximity::Obstacle::REMOVE;
    if (removes && obstacle.id.empty()) {
      touched.remove_all();
    } else if (removes) {
      touched.remove(obstacle.id);
    } else if (obstacle.operation == fiber_proximity::Obstacle::MOVE) {
      touched.move(obstacle.id);
    } else if (obstacle.operation == fiber_proximity::Obstacle::APPEND) {
      touched.append(obstacle.id);
    } else {
      touched.add(obstacle.id);
    }
    frames.push_back(
        {"obstacle " + fiber::quote(obstacle.id), removes ? std_msgs::Header() : obstacle.header});
  }
  const bool is_large = is_large_mesh(triangle_count(*obstacles));
  const auto prepare = [this, obstacles = std::move(obstacles)]() -> Change::Apply {
    Changes changes;
    std::vector<ros::Time> stamps;
    for (const fiber_proximity::Obstacle& obstacle : *obstacles) {
      changes.push_back(to_change(obstacle));
      stamps.push_back(obstacle.header.stamp);
    }
    return [this, changes, stamps](const Change::Poses& poses, const Change::Names& cancelled) {
      Changes placed = changes;
      for (std::size_t i = 0; i < placed.size(); ++i) {
        placed[i].object.pose = poses[i] * placed[i].object.pose;
      }
      apply(placed, stamps, cancelled);
    };
  };
  auto apply = Prepared<Change::Apply>(prepare, is_large ? &worker : nullptr);
  return {std::move(touched), std::move(frames), std::move(apply), patience, {}, {}};
}

SceneObstacles::SceneObstacles(const std::vector<fiber::SceneObstacle>& obstacles) {
  for (const fiber::SceneObstacle& obstacle : obstacles) {
    waiting_.push_back({obstacle, "not looked for yet"});
  }
}

bool SceneObstacles::update(ObstacleSet& obstacles, FixedFrame& frame) {
  const std::size_t before = waiting_.size();
  std::vector<Waiting> waiting;
  for (Waiting& next : waiting_) {
    fiber::ObjectChange addition{Operation::ADD, next.obstacle.object};
    const std::string& name = addition.object.name;
    if (obstacles.has(name)) {
      ROS_WARN_STREAM("obstacle '" << name << "' of the scene is left out: another of this name "
                                   << "was added before its transform was known");
      continue;
    }
    try {
      FramedName framed{"obstacle " + fiber::quote(name), {}};
      framed.header.frame_id = next.obstacle.frame_id;
      addition.object.pose = locate(framed, frame) * addition.object.pose;
      obstacles.apply({addition}, {ros::Time()});
    } catch (const std::exception& error) {  // above all TransformUnavailable
      next.error = error.what();
      waiting.push_back(std::move(next));
    }
  }
  waiting_ = std::move(waiting);
  return waiting_.size() != before;
}

std::vector<Unknown> SceneObstacles::unknown() const {
  std::vector<Unknown> unknown;
  for (const Waiting& waiting : waiting_) {
    unknown.push_back({"scene", waiting.obstacle.object.name, beginning_, waiting.error});
  }
  return unknown;
}

}  // namespace fiber_proximity_ros
