#include "src/ros/sim/sim_frames.hpp"

#include <ros/console.h>
#include <ros/init.h>

#include <stdexcept>

#include "src/sim/scene/obstacles.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

/// Tells when something has stopped to follow its frame, and when it follows again.
/// @param how it stopped, and why
template <class Followed>
void note(const Followed& followed, bool is_stopped, const std::string& how, bool& was_stopped) {
  if (is_stopped && !was_stopped) {
    ROS_WARN_STREAM(followed.what << how);
  } else if (!is_stopped && was_stopped) {
    ROS_INFO_STREAM(followed.what << " follows frame " << fiber::quote(followed.frame) << " again");
  }
  was_stopped = is_stopped;
}

}  // namespace

template <class Followed>
void SimFrames::watch(const Followed& followed, Watch& watch, const std::string& problem) const {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (problem.empty() || watch.since.isZero()) {
    watch.since = now;
  }
  note(followed, (now - watch.since).toSec() > timeout_, " stays where it is: " + problem,
       watch.is_frozen);
}

void SimFrames::wait_for(const fiber::SimDescription& description, const fiber::SimScene& scene,
                         double timeout) const {
  const ros::SteadyTime begin = ros::SteadyTime::now();
  const auto wait = [&](const auto& followed) {
    while (ros::ok()) {
      try {
        return world_.latest_pose(followed.frame, ros::Time(0)).pose;
      } catch (const TransformUnavailable& error) {
        if ((ros::SteadyTime::now() - begin).toSec() >= timeout) {
          throw std::invalid_argument(followed.what + ": nothing of frame " +
                                      fiber::quote(followed.frame) + " in " +
                                      std::to_string(timeout) + " s: " + error.what());
        }
        ros::WallDuration(0.05).sleep();
      }
    }
    return Eigen::Isometry3d(Eigen::Isometry3d::Identity());
  };
  for (const fiber::FollowedFrame& followed : scene.frames) {
    wait(followed);
  }
  for (const fiber::FollowedObstacle& followed : scene.obstacle_frames) {
    const Eigen::Isometry3d pose = wait(followed) * followed.in_frame;
    fiber::EnvironmentObject object = scene.motions()->obstacles()[followed.obstacle].object;
    object.pose = pose;
    fiber::with_context(followed.what + ", where frame " + fiber::quote(followed.frame) + " has it",
                        [&] { fiber::require_room(description, scene, object); });
    *followed.path = {{0.0, pose}};
    scene.stepper->moving_obstacles()->place(followed.obstacle, pose);
  }
}

template <class Followed>
std::optional<FramePose> SimFrames::look(const Followed& followed) {
  Watch& watch = watches_[followed.what];
  try {
    const FramePose frame = world_.latest_pose(followed.frame, ros::Time(0));
    // A static frame has no stamp, and is there for ever.
    const bool is_new = frame.stamp.isZero() || frame.stamp != watch.stamp;
    watch.stamp = frame.stamp;
    this->watch(followed, watch,
                is_new ? ""
                       : "nothing new of frame " + fiber::quote(followed.frame) +
                             " for more than " + std::to_string(timeout_) + " s");
    return frame;
  } catch (const TransformUnavailable& error) {
    this->watch(followed, watch, error.what());
    return std::nullopt;
  }
}

void SimFrames::follow(const fiber::SimScene& scene) {
  const double start = scene.stepper->time();
  for (const fiber::FollowedFrame& followed : scene.frames) {
    const fiber::Placement last = followed.path->back().second;
    fiber::Placement next = last;
    if (const std::optional<FramePose> frame = look(followed)) {
      const fiber::Placement& in_frame = followed.in_frame;
      // The hold goes as far on the way there as a frame leads.
      const fiber::Lead lead = fiber::lead(scene, {followed.rod, followed.node}, last.position,
                                           frame->pose * in_frame.position, fastest_frame);
      note(followed, !lead.problem.empty(),
           " does not follow frame " + fiber::quote(followed.frame) + ": " + lead.problem,
           watches_[followed.what].is_held_back);
      next = {lead.position, frame->pose.linear() * in_frame.tangent,
              frame->pose.linear() * in_frame.director};
    }
    *followed.path = {{start, last}, {start + scene.time_step, next}};
  }
  follow_obstacles(scene);
}

/// As far on their ways as none of their points is too fast, going straight.
void SimFrames::follow_obstacles(const fiber::SimScene& scene) {
  const double start = scene.stepper->time();
  for (const fiber::FollowedObstacle& followed : scene.obstacle_frames) {
    const Eigen::Isometry3d last = followed.path->back().second;
    Eigen::Isometry3d next = last;
    if (const std::optional<FramePose> frame = look(followed)) {
      next = frame->pose * followed.in_frame;
      const double way = (next.translation() - last.translation()).norm();
      const double longest = fastest_frame * scene.time_step;
      if (way > longest) {
        next = fiber::pose_at({{0.0, last}, {1.0, next}}, longest / way);
      }
    }
    *followed.path = {{start, last}, {start + scene.time_step, next}};
  }
}

}  // namespace fiber_proximity_ros
