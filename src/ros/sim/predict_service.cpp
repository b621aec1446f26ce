#include "src/ros/sim/predict_service.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/sim/joints.hpp"
#include "fiber_proximity/sim/scene/prediction.hpp"
#include "src/ros/detection/environment_detector.hpp"
#include "src/ros/environment/obstacle_change.hpp"
#include "src/ros/support/stopwatch.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber_proximity::Contact;
using Response = fiber_proximity::Predict::Response;

constexpr std::uint32_t max_predictions = 4;  // at once

/// Lets the running scene have the processor first. A thread cannot take this back, and only makes
/// predictions.
void give_way() {
  constexpr int niceness = 10;
  thread_local const int result = setpriority(PRIO_PROCESS, 0, niceness);  // of this thread alone
  static_cast<void>(result);  // without it predictions are no less right
}

/// A pose as that of a hold, in which its node is at a place and has these directions.
fiber::Placement placement_in(const Eigen::Isometry3d& pose, const fiber::Placement& held) {
  return {pose * held.position, pose.linear() * held.tangent, pose.linear() * held.director};
}

fiber::ObstaclePath poses_of(const fiber_proximity::HoldTrajectory& message) {
  if (message.times.size() != message.poses.size()) {
    throw std::invalid_argument("there are " + std::to_string(message.times.size()) +
                                " times for " + std::to_string(message.poses.size()) + " poses");
  }
  fiber::ObstaclePath poses;
  for (std::size_t i = 0; i < message.times.size(); ++i) {
    fiber::with_context("pose " + std::to_string(i),
                        [&] { poses.emplace_back(message.times[i], to_pose(message.poses[i])); });
  }
  return poses;
}

/// @param held the hold, in poses
fiber::HoldTrajectory trajectory_of(const fiber::ObstaclePath& poses, const fiber::NodeOfRod& node,
                                    const fiber::Placement& held) {
  fiber::HoldTrajectory trajectory{node.rod, node.node, {}};
  for (const auto& [time, pose] : poses) {
    trajectory.path.emplace_back(time, placement_in(pose, held));
  }
  return trajectory;
}

struct Trajectories {
  std::vector<fiber::HoldTrajectory> holds;
  std::vector<fiber::ObstacleTrajectory> obstacles;
};

/// Adds those of all holds and obstacles that the message is about.
void add_trajectories(const fiber::SimScene& scene, const fiber_proximity::HoldTrajectory& message,
                      Trajectories& trajectories) {
  const fiber::ObstaclePath poses = poses_of(message);
  if (message.frame.empty()) {
    const fiber::NodeOfRod node =
        fiber::find_node(scene, fiber::find_rod(scene, message.fiber), message.node);
    trajectories.holds.push_back(
        trajectory_of(poses, node, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()}));
    return;
  }
  bool is_any = false;
  for (const fiber::FollowedFrame& frame : scene.frames) {
    if (frame.frame == message.frame && scene.paths.count(frame.hold) > 0) {
      trajectories.holds.push_back(trajectory_of(poses, {frame.rod, frame.node}, frame.in_frame));
      is_any = true;
    }
  }
  for (const fiber::FollowedObstacle& followed : scene.obstacle_frames) {
    if (followed.frame == message.frame) {
      fiber::ObstaclePath& path =
          trajectories.obstacles.emplace_back(fiber::ObstacleTrajectory{followed.obstacle, poses})
              .path;
      for (auto& [time, pose] : path) {
        pose = pose * followed.in_frame;
      }
      is_any = true;
    }
  }
  if (!is_any) {
    throw std::invalid_argument("nothing is held by frame " + fiber::quote(message.frame) +
                                ", and no obstacle follows it");
  }
}

fiber_proximity::PredictedForce message_of(const fiber::GreatestForce& force) {
  fiber_proximity::PredictedForce message;
  message.fiber = force.rod;
  message.index = force.node;
  message.force = force.force;
  message.time = force.time;
  return message;
}

void fill_in(const fiber::Prediction& told, const SceneCopy& copy, Response& response) {
  fiber::FiberAssembly then = fiber::assembly_of(copy.scene.stepper->rods());
  for (const fiber::Prediction::Sample& sample : told.samples) {
    response.sample_times.push_back(sample.time);
    fiber_proximity::FiberArray& fibers = response.samples.emplace_back();
    then.update_points(sample.positions);
    to_message(then, copy.scene.fiber_names, fibers);
    fibers.header = copy.header;
    fibers.header.stamp += ros::Duration(sample.time);
  }
  for (const fiber::PredictedClearance& clearance : told.clearances) {
    to_message(clearance.contact, Contact::FIBER,
               clearance.is_object ? Contact::OBJECT : Contact::FIBER,
               response.clearances.emplace_back());
    response.clearance_times.push_back(clearance.time);
  }
  response.object_names = object_names(fiber::Environment(copy.scene.objects()));
  for (const fiber::PredictedTouch& touch : told.touches) {
    fiber_proximity::PredictedTouch& message = response.touches.emplace_back();
    message.fiber = touch.rod;
    message.type_b = touch.is_object ? Contact::OBJECT : Contact::FIBER;
    message.body_b = touch.other;
    message.first = touch.first;
    message.last = touch.last;
    message.force = touch.max_force;
    message.time = touch.time_of_max;
  }
  for (const fiber::GreatestForce& tension : told.tensions) {
    response.tensions.push_back(message_of(tension));
  }
  for (const fiber::GreatestForce& hold : told.holds) {
    response.holds.push_back(message_of(hold));
  }
  for (const fiber::GreatestForce& joint : told.joints) {
    response.joints.push_back(message_of(joint));
  }
  for (const fiber::PredictedWarning& warning : told.warnings) {
    response.warnings.push_back(warning.text);
    response.warning_times.push_back(warning.time);
  }
  response.time = told.time;
  response.unbalanced_frames = told.unbalanced_frames;
  response.success = told.problem.empty();
  response.message = told.problem;
}

}  // namespace

PredictService::PredictService(ros::NodeHandle private_node, std::function<SceneCopy()> copy,
                               std::function<bool()> is_ending)
    : copy_(std::move(copy)), is_ending_(std::move(is_ending)), spinner_(max_predictions, &queue_) {
  private_node.setCallbackQueue(&queue_);
  server_ = private_node.advertiseService("predict", &PredictService::predict, this);
  spinner_.start();
}

bool PredictService::predict(fiber_proximity::Predict::Request& request, Response& response) {
  const Stopwatch stopwatch;
  give_way();
  try {
    SceneCopy copy = copy_();
    Trajectories trajectories;
    for (std::size_t i = 0; i < request.trajectories.size(); ++i) {
      fiber::with_context("trajectory " + std::to_string(i), [&] {
        add_trajectories(copy.scene, request.trajectories[i], trajectories);
      });
    }
    fiber::follow(copy.scene, trajectories.holds);
    fiber::follow(copy.scene, trajectories.obstacles);
    fiber::PredictionOptions options;
    options.duration = request.duration;
    options.sample_period = request.sample_period;
    options.margin = request.margin;
    fill_in(fiber::predict(copy.scene, options, is_ending_), copy, response);
  } catch (const std::exception& error) {
    response.success = 0;
    response.message = error.what();
  }
  response.computing_time = stopwatch.seconds();
  return true;
}

}  // namespace fiber_proximity_ros
