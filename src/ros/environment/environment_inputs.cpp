#include "src/ros/environment/environment_inputs.hpp"

#include <algorithm>
#include <utility>

#include "src/ros/inputs/input_source.hpp"
#include "src/ros/support/part_of.hpp"
#include "src/ros/support/stamps.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

/// How many messages may wait. Obstacles are sent once each, so that none should be dropped.
constexpr std::uint32_t queue_size = 1000;

bool is_configured(const EnvironmentOptions& options) {
  return !options.scene.obstacles.empty() || !options.robot.empty() || options.cloud ||
         !options.marker_topics.empty() || options.obstacles_required;
}

/// Refuses a change whose stamps are in the future.
void check_stamps(Change& change, double max_ahead) {
  const ros::Time now = ros::Time::now();
  for (const FramedName& thing : change.frames) {
    try {
      fiber::with_context(thing.name, [&] { validate_stamp(thing.header.stamp, now, max_ahead); });
    } catch (const std::invalid_argument& error) {
      change.apply = refusal(error.what());
      return;
    }
  }
}

}  // namespace

struct EnvironmentInputs::MarkerSource {
  MarkerSource(const MarkerTopic& from, const MeshLoader& meshes, ObstacleSet& set,
               FixedFrame& frame, OwedChanges& owed)
      : obstacles(from.topic, meshes, set, frame),
        topic(from.topic,
              from.is_array ? "visualization_msgs/MarkerArray" : "visualization_msgs/Marker",
              from.required, from.topic, owed),
        changes(frame) {}

  MarkerObstacles obstacles;
  ChangeTopic topic;
  WaitingChanges changes;
};

EnvironmentInputs::EnvironmentInputs(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node,
                                     const EnvironmentOptions& options, FixedFrame& frame,
                                     std::function<void()> on_message)
    : frame_(frame),
      on_message_(std::move(on_message)),
      obstacles_(world_, tracks_),
      scene_(options.scene.obstacles),
      robot_(options.robot, options.robot_timeout),
      pose_timeout_(options.robot_timeout),
      obstacle_timeout_(options.obstacle_timeout),
      max_stamp_ahead_(options.max_stamp_ahead),
      max_lateness_(options.tf_timeout),
      obstacle_topic_name_(private_node.resolveName("obstacles")),
      obstacle_topic_(obstacle_topic_name_, "fiber_proximity/ObstacleArray",
                      options.obstacles_required, "", owed_),
      changes_(frame),
      has_scene_(!options.scene.obstacles.empty()),
      has_robot_(!options.robot.empty()),
      is_configured_(is_configured(options)) {
  ros::NodeHandle own(private_node);
  const auto on_change = [this] {
    was_changed_ = true;
    on_message_();
  };
  allowed_ = std::make_unique<AllowedPairsService>(own, options.scene.allowed, on_change);
  scene_.update(obstacles_, frame_);
  if (options.cloud) {
    cloud_ = std::make_unique<CloudInput>(own, *options.cloud, options.tf_timeout, max_stamp_ahead_,
                                          on_message_);
  }
  subscribers_.push_back(own.subscribe("obstacles", queue_size,
                                       &EnvironmentInputs::receive_obstacles, this,
                                       ros::TransportHints().tcpNoDelay()));
  subscribe_to_markers(node, options);  // after the node's own topics, which come first
  const auto apply = [this](ObstacleService::Obstacles obstacles,
                            const ObstacleService::Answer& answer) {
    this->apply(std::move(obstacles), answer);
  };
  obstacle_service_ = std::make_unique<ObstacleService>(own, apply);
}

EnvironmentInputs::~EnvironmentInputs() {
  changes_.clear();  // the service's threads wait for them
}

bool EnvironmentInputs::update(const ros::Time& stamp) {
  const ros::Time now = ros::Time::now();
  bool changed = watch_time(now);
  changed = std::exchange(was_changed_, false) || changed;
  changed = scene_.update(obstacles_, frame_) || changed;
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
  return robot_.update(stamp, find_pose, world_, tracks_) || changed;
}

/// Where time goes back, as a bag that begins again has it, clouds are forgotten, and lifetimes of
/// markers go on. InputSet tells the log.
/// @returns true if the world changed
bool EnvironmentInputs::watch_time(const ros::Time& now) {
  bool changed = false;
  if (now < last_time_) {
    changed = cloud_ != nullptr && cloud_->reset(now, world_);
    for (const std::unique_ptr<MarkerSource>& source : markers_) {
      source->obstacles.set_back(last_time_ - now);
    }
  }
  last_time_ = now;
  return changed;
}

bool EnvironmentInputs::is_waiting() const {
  return changes_.is_waiting() || (cloud_ != nullptr && cloud_->is_waiting()) ||
         std::any_of(markers_.begin(), markers_.end(),
                     [](const auto& source) { return source->changes.is_waiting(); });
}

std::vector<Unknown> EnvironmentInputs::unknown(bool of_contacts) const {
  std::vector<Unknown> all = left_out_;
  const auto add = [&all](const std::optional<Unknown>& unknown) {
    if (unknown) {
      all.push_back(*unknown);
    }
  };
  const auto is_there = [this](const std::string& name) { return world_.has(name); };
  append(scene_.unknown(), all);
  append(robot_.unknown(), all);
  add(obstacle_topic_.unknown());
  append(changes_.unknown(is_there, max_lateness_), all);
  for (const std::unique_ptr<MarkerSource>& source : markers_) {
    add(source->topic.unknown());
    append(source->changes.unknown(is_there, max_lateness_), all);
  }
  append(owed_.unknown(), all);
  if (cloud_ != nullptr) {
    add(cloud_->unknown(ros::Time::now()));
  }
  if (of_contacts) {
    all.erase(
        std::remove_if(all.begin(), all.end(),
                       [this](const Unknown& each) { return allowed_->may_touch_all(each.what); }),
        all.end());
  }
  return all;
}

std::vector<std::string> EnvironmentInputs::sources() const {
  std::vector<std::string> sources;
  if (has_scene_) {
    sources.emplace_back("scene");
  }
  if (has_robot_) {
    sources.emplace_back("robot");
  }
  for (const fiber_proximity::InputStatistics& topic : statistics(ros::Time::now())) {
    sources.push_back(topic.topic);
  }
  return sources;
}

std::vector<fiber_proximity::InputStatistics> EnvironmentInputs::statistics(
    const ros::Time& now) const {
  std::vector<fiber_proximity::InputStatistics> statistics{obstacle_topic_.statistics(now)};
  for (const std::unique_ptr<MarkerSource>& source : markers_) {
    statistics.push_back(source->topic.statistics(now));
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
    markers_.push_back(
        std::make_unique<MarkerSource>(topic, options.meshes, obstacles_, frame_, owed_));
    MarkerSource& source = *markers_.back();
    using Markers = MarkerObstacles::Markers;
    const boost::function<void(const MarkerArray::ConstPtr&)> receive_array =
        [this, &source](const MarkerArray::ConstPtr& message) {
          receive_markers(part_of(message, message->markers), source);
        };
    const boost::function<void(const Marker::ConstPtr&)> receive_one =
        [this, &source](const Marker::ConstPtr& message) {
          receive_markers(std::make_shared<const Markers>(1, *message), source);
        };
    const auto subscribe = [&] {
      const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
      subscribers_.push_back(
          topic.is_array
              ? node.subscribe<MarkerArray>(topic.topic, queue_size, receive_array, {}, hints)
              : node.subscribe<Marker>(topic.topic, queue_size, receive_one, {}, hints));
    };
    if (!subscribes("parameter ~obstacle_markers, topic '" + topic.topic + "'", subscribe)) {
      markers_.pop_back();
      left_out_.push_back({topic.topic, "obstacles of " + topic.topic, ros::Time::now(),
                           "its topic is subscribed to with another type already", true});
    }
  }
}

void EnvironmentInputs::receive_obstacles(const fiber_proximity::ObstacleArray::ConstPtr& message) {
  Change change =
      obstacles_.change_of(part_of(message, message->obstacles), obstacle_timeout_, mesh_builder_);
  check_stamps(change, max_stamp_ahead_);
  changes_.receive(obstacle_topic_.received(std::move(change)));
  on_message_();
}

void EnvironmentInputs::receive_markers(std::shared_ptr<const MarkerObstacles::Markers> markers,
                                        MarkerSource& source) {
  Change change = source.obstacles.change_of(std::move(markers), ros::Time::now(),
                                             obstacle_timeout_, mesh_builder_);
  check_stamps(change, max_stamp_ahead_);
  source.changes.receive(source.topic.received(std::move(change)));
  on_message_();
}

void EnvironmentInputs::apply(ObstacleService::Obstacles obstacles,
                              const ObstacleService::Answer& answer) {
  Change change = obstacles_.change_of(std::move(obstacles), 0.0, mesh_builder_);
  check_stamps(change, max_stamp_ahead_);
  change.source = obstacle_topic_name_;
  change.on_end = [this, answer, touched = change.touched](Change::End end,
                                                           const std::string& reason) {
    if (end == Change::End::APPLIED) {
      owed_.settle("", touched);
    } else if (end == Change::End::REFUSED) {
      owed_.refuse(obstacle_topic_name_, touched, ros::Time::now(), reason);
    }
    answer(end == Change::End::OVERTAKEN ? "all its objects were removed meanwhile" : reason);
  };
  changes_.receive(std::move(change));
  was_changed_ = changes_.update() || was_changed_;
  on_message_();
}

}  // namespace fiber_proximity_ros
