#include "src/ros/environment/robot_links.hpp"

#include <sstream>
#include <stdexcept>
#include <utility>

namespace fiber_proximity_ros {
namespace {

using Operation = fiber::ObjectChange::Operation;

}  // namespace

RobotLinks::RobotLinks(const std::vector<RobotLink>& links, double timeout) : timeout_(timeout) {
  for (const RobotLink& link : links) {
    links_.push_back({link.frame, link.object, false, "not looked for yet"});
  }
}

bool RobotLinks::update(const ros::Time& stamp, const FindPose& find_pose, fiber::World& world) {
  std::vector<fiber::ObjectChange> changes;
  for (Link& link : links_) {
    if (auto change = place(link, this->find_pose(link, stamp, find_pose))) {
      changes.push_back(std::move(*change));
    }
  }
  world.apply(changes);
  return !changes.empty();
}

std::vector<std::string> RobotLinks::unknown() const {
  std::vector<std::string> unknown;
  for (const Link& link : links_) {
    if (!link.is_present) {
      unknown.push_back(link.object.name + ": " + link.error);
    }
  }
  return unknown;
}

std::optional<fiber::ObjectChange> RobotLinks::place(Link& link,
                                                     const std::optional<Eigen::Isometry3d>& pose) {
  const bool was_present = std::exchange(link.is_present, pose.has_value());
  if (!was_present && !pose) {
    return std::nullopt;
  }
  if (was_present && pose && pose->matrix() == link.object.pose.matrix()) {
    return std::nullopt;
  }
  fiber::ObjectChange change;
  change.object.name = link.object.name;
  if (!pose) {
    change.operation = Operation::REMOVE;
    return change;
  }
  link.object.pose = *pose;
  change.operation = was_present ? Operation::MOVE : Operation::ADD;
  change.object.pose = *pose;
  if (!was_present) {
    change.object.shapes = link.object.shapes;
  }
  return change;
}

std::optional<Eigen::Isometry3d> RobotLinks::find_pose(Link& link, const ros::Time& stamp,
                                                       const FindPose& find_pose) const {
  try {
    const FramePose found = find_pose(link.frame, stamp);
    fiber::validate(found.pose);
    const double age = found.stamp.isZero() ? 0.0 : (stamp - found.stamp).toSec();
    if (age <= timeout_) {
      return found.pose;
    }
    std::ostringstream message;
    message << "its transform is " << age << " s old";
    link.error = message.str();
  } catch (const TransformUnavailable& error) {
    link.error = error.what();
  } catch (const std::invalid_argument& error) {
    link.error = error.what();
  }
  return std::nullopt;
}

}  // namespace fiber_proximity_ros
