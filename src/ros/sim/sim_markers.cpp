#include "src/ros/sim/sim_markers.hpp"

#include <ros/console.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using visualization_msgs::InteractiveMarker;
using visualization_msgs::InteractiveMarkerControl;
using visualization_msgs::InteractiveMarkerFeedback;
using visualization_msgs::Marker;

constexpr std::uint32_t max_fibers = 100;
constexpr double fastest_hand = 2.0;    // [m/s]
constexpr double warning_period = 5.0;  // [s]
constexpr double thickness = 3.0;       // of a handle, by that of its fibre

InteractiveMarker handle(const std::string& name, const std::string& frame, double radius,
                         const Vector3d& position) {
  InteractiveMarker marker;
  marker.header.frame_id = frame;
  marker.name = name;
  marker.description = "";
  marker.pose.position = to_message(position);
  marker.pose.orientation.w = 1.0;
  marker.scale = static_cast<float>(2.0 * thickness * radius);
  InteractiveMarkerControl control;
  control.interaction_mode = InteractiveMarkerControl::MOVE_3D;
  control.always_visible = 1;
  Marker ball;
  ball.type = Marker::SPHERE;
  ball.scale.x = ball.scale.y = ball.scale.z = marker.scale;
  ball.color.r = ball.color.g = ball.color.b = 0.9F;
  ball.color.a = 0.6F;
  control.markers.push_back(ball);
  marker.controls.push_back(control);
  return marker;
}

}  // namespace

SimMarkers::SimMarkers(const std::string& topic, const FixedFrame& world)
    : world_(world), server_(topic) {}

void SimMarkers::begin(const fiber::SimScene& scene) {
  server_.clear();
  ends_.clear();
  grabs_.clear();
  const fiber::Rods& rods = scene.stepper->rods();
  for (std::uint32_t rod = 0; rod < std::min(max_fibers, rods.count()); ++rod) {
    const std::string& fiber = scene.fiber_names[rod];
    // The last node of a closed fibre is its first one.
    for (const auto& [name, node] :
         {std::make_pair(fiber + "/first", 0U),
          std::make_pair(fiber + "/last", rods.given_node_count(rod) - 1)}) {
      ends_[name] = {rod, node};
      server_.insert(handle(name, scene.frame_id, rods.node_radius(rod, rods.first(rod) + node),
                            rods.positions[rods.first(rod) + node]),
                     [this](const auto& feedback) { receive(*feedback); });
    }
  }
  server_.applyChanges();
}

void SimMarkers::receive(const InteractiveMarkerFeedback& feedback) {
  const bool is_pose = feedback.event_type == InteractiveMarkerFeedback::POSE_UPDATE;
  if (!is_pose && feedback.event_type != InteractiveMarkerFeedback::MOUSE_UP) {
    return;
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  // Nothing is taken over while the simulation is paused: of a handle, only the latest counts.
  const auto is_same = [&feedback](const InteractiveMarkerFeedback& other) {
    return other.marker_name == feedback.marker_name && other.event_type == feedback.event_type;
  };
  received_.erase(std::remove_if(received_.begin(), received_.end(), is_same), received_.end());
  received_.push_back(feedback);
}

void SimMarkers::apply(fiber::SimScene& scene) {
  std::vector<InteractiveMarkerFeedback> received;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    received.swap(received_);
  }
  for (const InteractiveMarkerFeedback& feedback : received) {
    const auto end = ends_.find(feedback.marker_name);
    const bool is_pose = feedback.event_type == InteractiveMarkerFeedback::POSE_UPDATE;
    const bool is_up = feedback.event_type == InteractiveMarkerFeedback::MOUSE_UP;
    if (end == ends_.end() || !(is_pose || (is_up && grabs_.count(end->first) != 0))) {
      continue;
    }
    try {
      const Vector3d target =
          world_.transform_from(feedback.header) * to_vector(feedback.pose.position);
      Grab& grab = grabs_[end->first];
      if (grab.path == nullptr) {
        const auto& [rod, node] = end->second;
        grab.was_held = scene.attachment->find(rod, node).has_value();
        const Vector3d& here = fiber::position_of(scene.stepper->rods(), end->second);
        const fiber::Placement placement{here, Vector3d::UnitX(), Vector3d::UnitY()};
        grab.path = std::make_shared<fiber::PlacementPath>(1, std::make_pair(0.0, placement));
        fiber::hold_on_path(scene, end->second, grab.path);
      }
      grab.is_over = is_up;
      grab.target = is_up ? grab.target : target;
    } catch (const TransformUnavailable& error) {
      ROS_WARN_STREAM("the handle " << end->first << " is not dragged: " << error.what());
    }
  }
  for (auto grabbed = grabs_.begin(); grabbed != grabs_.end();) {
    const Grab& grab = grabbed->second;
    const fiber::NodeOfRod& end = ends_.at(grabbed->first);
    if (grab.is_over) {
      const auto id = scene.attachment->find(end.rod, end.node);
      if (id && !grab.was_held) {
        fiber::remove_hold(scene, *id);
      }
      grabbed = grabs_.erase(grabbed);
      continue;
    }
    const fiber::Placement last = grab.path->back().second;
    const fiber::Lead lead = fiber::lead(scene, end, last.position, grab.target, fastest_hand);
    if (!lead.problem.empty()) {
      ROS_WARN_STREAM_THROTTLE(warning_period, "the handle "
                                                   << grabbed->first
                                                   << " is not followed further: " << lead.problem);
    }
    const double start = scene.stepper->time();
    fiber::Placement next = last;
    next.position = lead.position;
    *grab.path = {{start, last}, {start + scene.time_step, next}};
    ++grabbed;
  }
}

void SimMarkers::update(const fiber::SimScene& scene) {
  const fiber::Rods& rods = scene.stepper->rods();
  for (const auto& [name, end] : ends_) {
    geometry_msgs::Pose pose;
    pose.position = to_message(fiber::position_of(rods, end));
    pose.orientation.w = 1.0;
    server_.setPose(name, pose);
  }
  server_.applyChanges();
}

}  // namespace fiber_proximity_ros
