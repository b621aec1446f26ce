#include "fiber_proximity/ros/environment_inputs.hpp"

#include <ros/console.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace fiber_proximity_ros {
namespace {

/// [message] Obstacles are sent once each, so that none should be dropped.
constexpr std::uint32_t queue_size = 1000;

/// [s] How often what is unknown is logged, and how long it may be so without.
constexpr double warning_period = 5.0;

bool is_configured(const EnvironmentOptions& options) {
  return !options.scene.obstacles.empty() || !options.robot.empty() || options.cloud ||
         !options.marker_topics.empty();
}

fiber_proximity::AllowPairs::Request allow_all(
    const std::vector<fiber_proximity::AllowedPair>& pairs) {
  fiber_proximity::AllowPairs::Request request;
  request.allow = pairs;
  return request;
}

}  // namespace

EnvironmentInputs::MarkerSource::MarkerSource(const MarkerTopic& topic, const MeshLoader& meshes,
                                              ObstacleSet& set, double timeout)
    : obstacles(topic.topic, meshes, set),
      changes(topic.topic,
              topic.is_array ? "visualization_msgs/MarkerArray" : "visualization_msgs/Marker",
              timeout) {}

EnvironmentInputs::EnvironmentInputs(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node,
                                     const EnvironmentOptions& options, FixedFrame& frame,
                                     double tf_timeout, std::function<void()> on_message)
    : frame_(frame),
      on_message_(std::move(on_message)),
      obstacles_(world_, frame),
      scene_(options.scene.obstacles),
      robot_(options.robot, options.robot_timeout),
      changes_("obstacles", "fiber_proximity/ObstacleArray", options.obstacle_timeout),
      is_configured_(is_configured(options)) {
  allowed_.apply(allow_all(options.scene.allowed));
  scene_.update(obstacles_);
  ros::NodeHandle own(private_node);
  if (options.cloud) {
    cloud_ = std::make_unique<CloudInput>(own, *options.cloud, tf_timeout, on_message_);
  }
  subscribe_to_markers(node, options);
  const boost::function<void(const fiber_proximity::ObstacleArray&)> receiver =
      [this](const fiber_proximity::ObstacleArray& message) { receive(message); };
  subscribers_.push_back(
      own.subscribe<fiber_proximity::ObstacleArray, const fiber_proximity::ObstacleArray&>(
          "obstacles", queue_size, receiver));
  servers_.push_back(own.advertiseService("apply_obstacles", &EnvironmentInputs::apply, this));
  servers_.push_back(own.advertiseService("allow_pairs", &EnvironmentInputs::allow, this));
}

bool EnvironmentInputs::update(const ros::Time& stamp) {
  const ros::Time now = ros::Time::now();
  bool changed = std::exchange(was_changed_, false);
  changed = scene_.update(obstacles_) || changed;
  changed = changes_.update() || changed;
  for (const std::unique_ptr<MarkerSource>& source : markers_) {
    changed = source->changes.update() || changed;
    changed = source->obstacles.expire(now) || changed;
  }
  if (cloud_ != nullptr) {
    changed = cloud_->update(now, frame_, world_) || changed;
  }
  const auto find_pose = [this](const std::string& frame, const ros::Time& time) {
    return frame_.latest_pose(frame, time);
  };
  changed = robot_.update(stamp, find_pose, world_) || changed;
  warn_of_unknown();
  return changed;
}

bool EnvironmentInputs::is_waiting() const {
  return changes_.is_waiting() || (cloud_ != nullptr && cloud_->is_waiting()) ||
         std::any_of(markers_.begin(), markers_.end(),
                     [](const auto& source) { return source->changes.is_waiting(); });
}

std::vector<std::string> EnvironmentInputs::unknown() const {
  std::vector<std::string> unknown = scene_.unknown();
  const std::vector<std::string> links = robot_.unknown();
  unknown.insert(unknown.end(), links.begin(), links.end());
  return unknown;
}

std::vector<fiber_proximity::InputStatistics> EnvironmentInputs::statistics(
    const ros::Time& now) const {
  std::vector<fiber_proximity::InputStatistics> statistics{changes_.statistics(now)};
  for (const std::unique_ptr<MarkerSource>& source : markers_) {
    statistics.push_back(source->changes.statistics(now));
  }
  if (cloud_ != nullptr) {
    statistics.push_back(cloud_->statistics(now));
  }
  return statistics;
}

void EnvironmentInputs::subscribe_to_markers(ros::NodeHandle node,
                                             const EnvironmentOptions& options) {
  using visualization_msgs::Marker;
  using visualization_msgs::MarkerArray;
  for (const MarkerTopic& topic : options.marker_topics) {
    markers_.push_back(std::make_unique<MarkerSource>(topic, options.meshes, obstacles_,
                                                      options.obstacle_timeout));
    MarkerSource& source = *markers_.back();
    const boost::function<void(const MarkerArray&)> receive_array =
        [this, &source](const MarkerArray& message) { receive(message.markers, source); };
    const boost::function<void(const Marker&)> receive_one =
        [this, &source](const Marker& message) { receive({message}, source); };
    subscribers_.push_back(topic.is_array ? node.subscribe<MarkerArray, const MarkerArray&>(
                                                topic.topic, queue_size, receive_array)
                                          : node.subscribe<Marker, const Marker&>(
                                                topic.topic, queue_size, receive_one));
  }
}

void EnvironmentInputs::receive(const fiber_proximity::ObstacleArray& message) {
  try {
    changes_.receive(
        [this, changes = to_changes(message.obstacles)] { obstacles_.apply(changes); });
  } catch (const std::invalid_argument& error) {
    changes_.refuse(error.what());
  }
  on_message_();
}

void EnvironmentInputs::receive(const MarkerObstacles::Markers& markers, MarkerSource& source) {
  try {
    source.changes.receive(source.obstacles.read(markers, ros::Time::now()));
  } catch (const std::invalid_argument& error) {
    source.changes.refuse(error.what());
  }
  on_message_();
}

bool EnvironmentInputs::apply(fiber_proximity::ApplyObstacles::Request& request,
                              fiber_proximity::ApplyObstacles::Response& response) {
  try {
    obstacles_.apply(to_changes(request.obstacles));
    response.success = true;
    was_changed_ = true;
    on_message_();
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

bool EnvironmentInputs::allow(fiber_proximity::AllowPairs::Request& request,
                              fiber_proximity::AllowPairs::Response& response) {
  try {
    allowed_.apply(request);
    response.success = true;
    was_changed_ = true;
    on_message_();
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  response.allowed = allowed_.pairs();
  return true;
}

void EnvironmentInputs::warn_of_unknown() const {
  const std::vector<std::string> unknown = this->unknown();
  if (!unknown.empty()) {
    ROS_WARN_STREAM_DELAYED_THROTTLE(
        warning_period, unknown.size() << " object(s) are left out of the environment, the first: "
                                       << unknown.front());
  }
}

}  // namespace fiber_proximity_ros
