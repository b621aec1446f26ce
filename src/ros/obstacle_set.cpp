#include "fiber_proximity/ros/obstacle_set.hpp"

#include <utility>

#include "fiber_proximity/ros/obstacle_change.hpp"

namespace fiber_proximity_ros {
namespace {

using Changes = std::vector<fiber::ObjectChange>;
using Operation = fiber::ObjectChange::Operation;

void remove_all(std::set<std::string>& names, Changes& changes) {
  for (const std::string& name : std::exchange(names, {})) {
    fiber::ObjectChange change;
    change.operation = Operation::REMOVE;
    change.object.name = name;
    changes.push_back(std::move(change));
  }
}

}  // namespace

std::vector<FramedChange> to_changes(const std::vector<fiber_proximity::Obstacle>& obstacles) {
  std::vector<FramedChange> changes;
  for (const fiber_proximity::Obstacle& obstacle : obstacles) {
    changes.push_back({obstacle.header, to_change(obstacle)});
  }
  return changes;
}

void ObstacleSet::apply(const std::vector<FramedChange>& changes) {
  std::set<std::string> names = names_;
  Changes placed;
  for (const FramedChange& framed : changes) {
    const std::string& name = framed.change.object.name;
    if (framed.change.operation != Operation::REMOVE) {
      placed.push_back(place(framed));
      names.insert(name);
    } else if (name.empty()) {
      remove_all(names, placed);
    } else {
      placed.push_back(framed.change);
      names.erase(name);
    }
  }
  world_.apply(placed);
  names_ = std::move(names);
}

fiber::ObjectChange ObstacleSet::place(const FramedChange& framed) {
  std_msgs::Header header = framed.header;
  header.frame_id = tf2_name(header.frame_id);
  frame_.adopt(header.frame_id);
  fiber::ObjectChange change = framed.change;
  try {
    change.object.pose = frame_.transform_from(header) * change.object.pose;
  } catch (const TransformUnavailable& error) {
    throw TransformUnavailable("obstacle '" + change.object.name + "': " + error.what());
  }
  return change;
}

}  // namespace fiber_proximity_ros
