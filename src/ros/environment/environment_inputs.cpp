#include "src/ros/environment/environment_inputs.hpp"

#include <ros/callback_queue.h>
#include <ros/console.h>
#include <ros/spinner.h>

#include <algorithm>
#include <exception>
#include <future>
#include <mutex>
#include <utility>

#include "fiber_proximity/ApplyObstacles.h"
#include "src/ros/inputs/input_source.hpp"
#include "src/ros/support/callback_task.hpp"

namespace fiber_proximity_ros {
namespace {

/// [message] Obstacles are sent once each, so that none should be dropped.
constexpr std::uint32_t queue_size = 1000;

/// Requests that may wait at the same time, as those of different clients do for large meshes.
constexpr std::uint32_t waiting_request_count = 4;

/// [s] How often what is unknown is logged, and how long it may be so without.
constexpr double warning_period = 5.0;

bool is_configured(const EnvironmentOptions& options) {
  return !options.scene.obstacles.empty() || !options.robot.empty() || options.cloud ||
         !options.marker_topics.empty();
}

/// A part of a message, which keeps the message alive.
template <class Message, class Part>
std::shared_ptr<const Part> part_of(const boost::shared_ptr<const Message>& message,
                                    const Part& part) {
  return std::shared_ptr<const Part>(&part, [message](const Part* /*part*/) {});
}

std::vector<fiber::NamedPair> to_pairs(const std::vector<fiber_proximity::AllowedPair>& messages) {
  std::vector<fiber::NamedPair> pairs;
  for (const fiber_proximity::AllowedPair& message : messages) {
    pairs.push_back({message.object, message.fiber, message.segments});
  }
  return pairs;
}

std::vector<fiber_proximity::AllowedPair> to_messages(const std::vector<fiber::NamedPair>& pairs) {
  std::vector<fiber_proximity::AllowedPair> messages(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    messages[i].object = pairs[i].object;
    messages[i].fiber = pairs[i].fiber;
    messages[i].segments = pairs[i].segments;
  }
  return messages;
}

}  // namespace

/// Serves ~apply_obstacles. roscpp answers a service when its callback returns, so callbacks come
/// from threads of their own and wait there until the node has made the change: meanwhile the
/// node's thread goes on.
class EnvironmentInputs::ObstacleService {
 public:
  ObstacleService(const ros::NodeHandle& private_node, EnvironmentInputs& inputs)
      : inputs_(inputs),
        queue_(queue_of(private_node)),
        spinner_(waiting_request_count, &own_queue_) {
    ros::NodeHandle node(private_node);
    node.setCallbackQueue(&own_queue_);
    server_ = node.advertiseService("apply_obstacles", &ObstacleService::apply, this);
    spinner_.start();
  }

  /// All answers must have been called or dropped.
  ~ObstacleService() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      stops_ = true;
    }
    remove_tasks(queue_, this);
    spinner_.stop();
    server_.shutdown();
  }
  ObstacleService(const ObstacleService&) = delete;
  ObstacleService& operator=(const ObstacleService&) = delete;

 private:
  bool apply(fiber_proximity::ApplyObstacles::Request& request,
             fiber_proximity::ApplyObstacles::Response& response) {
    auto promise = std::make_shared<std::promise<std::string>>();
    std::future<std::string> reason = promise->get_future();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!stops_) {
        auto obstacles = std::make_shared<const Obstacles>(std::move(request.obstacles));
        add_task(queue_, this, [this, obstacles, promise = std::move(promise)] {
          inputs_.apply(obstacles, [promise](const std::string& why) { promise->set_value(why); });
        });
      }
    }
    promise.reset();  // the task's is the last: once that is gone nobody will answer
    try {
      response.message = reason.get();
      response.success = response.message.empty();
    } catch (const std::future_error&) {
      response.message = "the node ends";
    }
    return true;
  }

  EnvironmentInputs& inputs_;
  ros::CallbackQueueInterface& queue_;  // of the node
  ros::CallbackQueue own_queue_;
  std::mutex mutex_;
  bool stops_ = false;
  ros::ServiceServer server_;
  ros::AsyncSpinner spinner_;
};

struct EnvironmentInputs::MarkerSource {
  MarkerSource(const MarkerTopic& from, const MeshLoader& meshes, ObstacleSet& set,
               FixedFrame& frame)
      : obstacles(from.topic, meshes, set),
        topic(from.topic,
              from.is_array ? "visualization_msgs/MarkerArray" : "visualization_msgs/Marker"),
        changes(frame) {}

  MarkerObstacles obstacles;
  ChangeTopic topic;
  WaitingChanges changes;
};

EnvironmentInputs::EnvironmentInputs(const ros::NodeHandle& node,
                                     const ros::NodeHandle& private_node,
                                     const EnvironmentOptions& options, FixedFrame& frame,
                                     double tf_timeout, std::function<void()> on_message)
    : frame_(frame),
      on_message_(std::move(on_message)),
      obstacles_(world_),
      scene_(options.scene.obstacles),
      robot_(options.robot, options.robot_timeout),
      obstacle_timeout_(options.obstacle_timeout),
      obstacle_topic_("obstacles", "fiber_proximity/ObstacleArray"),
      changes_(frame),
      is_configured_(is_configured(options)) {
  allowed_.apply(false, {}, options.scene.allowed);
  scene_.update(obstacles_, frame_);
  ros::NodeHandle own(private_node);
  if (options.cloud) {
    cloud_ = std::make_unique<CloudInput>(own, *options.cloud, tf_timeout, on_message_);
  }
  subscribers_.push_back(
      own.subscribe("obstacles", queue_size, &EnvironmentInputs::receive_obstacles, this));
  subscribe_to_markers(node, options);  // after the node's own topics, which come first
  obstacle_service_ = std::make_unique<ObstacleService>(own, *this);
  servers_.push_back(own.advertiseService("allow_pairs", &EnvironmentInputs::allow, this));
}

EnvironmentInputs::~EnvironmentInputs() {
  changes_.clear();  // the service's threads wait for them
}

bool EnvironmentInputs::update(const ros::Time& stamp) {
  const ros::Time now = ros::Time::now();
  bool changed = std::exchange(was_changed_, false);
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
    markers_.push_back(std::make_unique<MarkerSource>(topic, options.meshes, obstacles_, frame_));
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
      subscribers_.push_back(
          topic.is_array ? node.subscribe<MarkerArray>(topic.topic, queue_size, receive_array)
                         : node.subscribe<Marker>(topic.topic, queue_size, receive_one));
    };
    if (!subscribes("parameter ~obstacle_markers, topic '" + topic.topic + "'", subscribe)) {
      markers_.pop_back();
    }
  }
}

void EnvironmentInputs::receive_obstacles(const fiber_proximity::ObstacleArray::ConstPtr& message) {
  changes_.receive(obstacle_topic_.received(obstacles_.change_of(
      part_of(message, message->obstacles), obstacle_timeout_, mesh_builder_)));
  on_message_();
}

void EnvironmentInputs::receive_markers(std::shared_ptr<const MarkerObstacles::Markers> markers,
                                        MarkerSource& source) {
  source.changes.receive(source.topic.received(source.obstacles.change_of(
      std::move(markers), ros::Time::now(), obstacle_timeout_, mesh_builder_)));
  on_message_();
}

void EnvironmentInputs::apply(std::shared_ptr<const Obstacles> obstacles, const Answer& answer) {
  Change change = obstacles_.change_of(std::move(obstacles), 0.0, mesh_builder_);
  change.on_end = [answer](Change::End end, const std::string& reason) {
    answer(end == Change::End::OVERTAKEN ? "all its objects were removed meanwhile" : reason);
  };
  changes_.receive(std::move(change));
  was_changed_ = changes_.update() || was_changed_;
  on_message_();
}

bool EnvironmentInputs::allow(fiber_proximity::AllowPairs::Request& request,
                              fiber_proximity::AllowPairs::Response& response) {
  try {
    allowed_.apply(request.reset != 0, to_pairs(request.forbid), to_pairs(request.allow));
    response.success = true;
    was_changed_ = true;
    on_message_();
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  response.allowed = to_messages(allowed_.pairs());
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
