#include "src/ros/environment/obstacle_set.hpp"

#include <utility>

#include "src/ros/environment/obstacle_change.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using Changes = std::vector<fiber::ObjectChange>;
using Obstacles = std::vector<fiber_proximity::Obstacle>;
using Operation = fiber::ObjectChange::Operation;

void remove_all(std::set<std::string>& names, Changes& changes) {
  for (const std::string& name : std::exchange(names, {})) {
    fiber::ObjectChange change;
    change.operation = Operation::REMOVE;
    change.object.name = name;
    changes.push_back(std::move(change));
  }
}

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

std::vector<FramedChange> to_changes(const std::vector<fiber_proximity::Obstacle>& obstacles) {
  std::vector<FramedChange> changes;
  for (const fiber_proximity::Obstacle& obstacle : obstacles) {
    changes.push_back({obstacle.header, to_change(obstacle)});
  }
  return changes;
}

FramedName framed_name(const FramedChange& framed) {
  return {"obstacle " + fiber::quote(framed.change.object.name), framed.header};
}

fiber::ObjectChange placed(const FramedChange& framed, const Eigen::Isometry3d& pose) {
  fiber::ObjectChange change = framed.change;
  change.object.pose = pose * change.object.pose;
  return change;
}

void ObstacleSet::apply(const Changes& changes, const std::set<std::string>& cancelled) {
  std::set<std::string> names = names_;
  Changes steps;
  for (const fiber::ObjectChange& change : changes) {
    const std::string& name = change.object.name;
    if (change.operation != Operation::REMOVE) {
      steps.push_back(change);
      names.insert(name);
    } else if (name.empty()) {
      remove_all(names, steps);
    } else if (names.erase(name) > 0 || cancelled.count(name) == 0) {
      steps.push_back(change);
    }
  }
  world_.apply(steps);
  names_ = std::move(names);
}

Change ObstacleSet::change_of(std::shared_ptr<const Obstacles> obstacles, double patience,
                              Worker& worker) {
  TouchedObjects touched;
  std::vector<FramedName> frames;
  for (const fiber_proximity::Obstacle& obstacle : *obstacles) {
    const bool removes = obstacle.operation == fiber_proximity::Obstacle::REMOVE;
    if (!removes) {
      touched.add(obstacle.id);
    } else if (obstacle.id.empty()) {
      touched.remove_all();
    } else {
      touched.remove(obstacle.id);
    }
    frames.push_back(
        {"obstacle " + fiber::quote(obstacle.id), removes ? std_msgs::Header() : obstacle.header});
  }
  const bool is_large = is_large_mesh(triangle_count(*obstacles));
  const auto prepare = [this, obstacles = std::move(obstacles)]() -> Change::Apply {
    return [this, changes = to_changes(*obstacles)](const Change::Poses& poses,
                                                    const Change::Names& cancelled) {
      Changes steps;
      for (std::size_t i = 0; i < changes.size(); ++i) {
        steps.push_back(placed(changes[i], poses[i]));
      }
      apply(steps, cancelled);
    };
  };
  auto apply = Prepared<Change::Apply>::of(prepare, worker, is_large);
  return {std::move(touched), std::move(frames), std::move(apply), patience, {}};
}

}  // namespace fiber_proximity_ros
