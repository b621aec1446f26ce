#include "src/ros/sim/sim_obstacles.hpp"

#include <ros/console.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/ros/environment/obstacle_change.hpp"
#include "src/ros/sim/sim_frames.hpp"
#include "src/ros/support/part_of.hpp"
#include "src/sim/scene/obstacle_motion.hpp"
#include "src/sim/scene/obstacles.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

using Operation = fiber::ObjectChange::Operation;

/// How many messages may wait. Obstacles are sent once each, so that none should be dropped.
constexpr std::uint32_t queue_size = 1000;

constexpr double longest_move = 1.0;   // [s]
constexpr double refusal_pause = 5.0;  // [s]

bool is_of_scene(const fiber::SimDescription& description, const std::string& name) {
  const auto has_name = [&name](const fiber::EnvironmentObject& object) {
    return object.name == name;
  };
  const std::vector<fiber::EnvironmentObject>& still = description.environment->objects();
  return std::any_of(still.begin(), still.end(), has_name) ||
         std::any_of(description.moving_obstacles.begin(), description.moving_obstacles.end(),
                     [&](const auto& moving) { return has_name(moving.object); });
}

bool has_same_shapes(fiber::EnvironmentObject a, fiber::EnvironmentObject b) {
  a.pose = b.pose = Eigen::Isometry3d::Identity();
  return a.shapes.size() == b.shapes.size() && to_obstacle(a, "") == to_obstacle(b, "");
}

}  // namespace

SimObstacles::SimObstacles(ros::NodeHandle node, FixedFrame& frame, double patience)
    : topic_(node.resolveName("obstacles")),
      patience_(patience),
      obstacles_(world_,
                 {[this](const auto& changes) { check(changes); },
                  [this](const auto& change, const ros::Time& stamp) { take(change, stamp); }}),
      changes_(frame),
      subscriber_(node.subscribe("obstacles", queue_size, &SimObstacles::receive, this,
                                 ros::TransportHints().tcpNoDelay())) {}

void SimObstacles::receive(const fiber_proximity::ObstacleArray::ConstPtr& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (received_.size() < queue_size) {
    received_.push_back(message);
  } else {
    ROS_WARN_STREAM_THROTTLE(refusal_pause, "obstacles of "
                                                << topic_ << " are refused: " << queue_size
                                                << " messages wait for the simulation to go on");
  }
}

void SimObstacles::apply(const fiber::SimDescription& description, fiber::SimScene& scene) {
  std::vector<fiber_proximity::ObstacleArray::ConstPtr> received;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    received.swap(received_);
  }
  description_ = &description;
  scene_ = &scene;
  for (const fiber_proximity::ObstacleArray::ConstPtr& message : received) {
    Change change =
        obstacles_.change_of(part_of(message, message->obstacles), patience_, mesh_builder_);
    change.source = topic_;
    change.on_end = [this](Change::End end, const std::string& reason) {
      if (end == Change::End::REFUSED) {
        ROS_WARN_STREAM("obstacles of " << topic_ << " are refused: " << reason);
      }
    };
    changes_.receive(std::move(change));
  }
  changes_.update();
}

void SimObstacles::begin(const fiber::SimDescription& description, fiber::SimScene& scene) {
  description_ = &description;
  scene_ = &scene;
  // Held: what is removed below makes another.
  const std::shared_ptr<const fiber::Environment> environment = world_.environment();
  for (const fiber::EnvironmentObject& object : environment->objects()) {
    try {
      check({{Operation::ADD, object}});
      fiber::add_obstacle(scene, object);
    } catch (const std::invalid_argument& error) {
      ROS_WARN_STREAM("obstacles of " << topic_ << " are removed: " << error.what());
      obstacles_.apply({removal_of(object.name)}, {ros::Time()});
    }
  }
}

/// Nothing may appear where a fibre is.
void SimObstacles::check(const std::vector<fiber::ObjectChange>& changes) const {
  for (const fiber::ObjectChange& change : changes) {
    const std::string& name = change.object.name;
    fiber::validate(change);
    fiber::with_context("obstacle " + fiber::quote(name), [&] {
      const bool removes = change.operation == Operation::REMOVE && world_.has(name);
      if (!removes && is_of_scene(*description_, name)) {
        throw std::invalid_argument("the scene has an obstacle of this name, which stays its own");
      }
      if (!scene_->stepper->takes_moving_obstacles()) {
        throw std::invalid_argument("the scene has no environment_contact: nothing would touch it");
      }
      if (change.operation != Operation::ADD && change.operation != Operation::APPEND) {
        return;
      }
      fiber::EnvironmentObject object = change.object;
      if (const fiber::AddedObstacle* const added = fiber::find_added(*scene_, name)) {
        const fiber::EnvironmentObject present = fiber::placed(*scene_, *added);
        if (change.operation == Operation::ADD && has_same_shapes(present, object)) {
          return;  // it moves
        }
        object.pose = change.operation == Operation::APPEND ? present.pose : object.pose;
      }
      fiber::require_room(*description_, *scene_, object);
    });
  }
}

void SimObstacles::take(const fiber::ObjectChange& change, const ros::Time& stamp) {
  fiber::EnvironmentObject object = change.object;
  const fiber::AddedObstacle* const added = fiber::find_added(*scene_, object.name);
  if (change.operation == Operation::REMOVE) {
    stamps_.erase(object.name);
    if (added != nullptr) {
      fiber::remove_obstacle(*scene_, *added);
    }
    return;
  }
  if (added == nullptr) {
    fiber::add_obstacle(*scene_, object);
    stamps_[object.name] = stamp;
    return;
  }
  fiber::EnvironmentObject present = fiber::placed(*scene_, *added);
  if (change.operation == Operation::MOVE ||
      (change.operation == Operation::ADD && has_same_shapes(present, object))) {
    move(*added, object.pose, stamp);
    return;
  }
  if (change.operation == Operation::APPEND) {
    present.shapes.insert(present.shapes.end(), object.shapes.begin(), object.shapes.end());
    fiber::replace_shapes(*scene_, *added, present.shapes);
    return;
  }
  fiber::remove_obstacle(*scene_, *added);
  fiber::add_obstacle(*scene_, object);
  stamps_[object.name] = stamp;
}

/// With the velocity that follows from the stamps.
void SimObstacles::move(const fiber::AddedObstacle& added, const Eigen::Isometry3d& pose,
                        const ros::Time& stamp) {
  const double least =
      std::max((stamp - std::exchange(stamps_[added.name], stamp)).toSec(), scene_->time_step);
  const fiber::EnvironmentObject present = fiber::placed(*scene_, added);
  const double turn = Eigen::AngleAxisd(present.pose.linear().transpose() * pose.linear()).angle();
  const double way =
      (pose.translation() - present.pose.translation()).norm() + turn * fiber::reach_of(present);
  fiber::move_obstacle(
      *scene_, added, pose,
      std::max(std::min(least, std::max(longest_move, scene_->time_step)), way / fastest_frame));
}

}  // namespace fiber_proximity_ros
