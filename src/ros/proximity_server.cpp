#include "fiber_proximity/ros/proximity_server.hpp"

#include <ros/callback_queue.h>
#include <ros/console.h>

#include <functional>
#include <limits>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/ros/shape_query.hpp"
#include "fiber_proximity/ros/stopwatch.hpp"

namespace fiber_proximity_ros {
namespace {

/// [s] How often what needs no message is looked after: expired inputs, diagnostics, late markers.
constexpr double tick_interval = 0.1;

/// [s] How often a message that waits for its transform is tried again.
constexpr double retry_interval = 0.005;

/// A function in a callback queue.
class Task : public ros::CallbackInterface {
 public:
  explicit Task(std::function<void()> function) : function_(std::move(function)) {}
  CallResult call() override {
    function_();
    return Success;
  }

 private:
  std::function<void()> function_;
};

ros::CallbackQueueInterface& queue_of(const ros::NodeHandle& node) {
  ros::CallbackQueueInterface* queue = node.getCallbackQueue();
  return queue != nullptr ? *queue : *ros::getGlobalCallbackQueue();
}

std::uint64_t id_of(const ProximityServer* server) {
  return reinterpret_cast<std::uintptr_t>(server);
}

}  // namespace

ProximityServer::ProximityServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(node),
      private_node_(private_node),
      options_(read_server_options(private_node)),
      detector_(options_.engine, options_.engine_options),
      contacts_publisher_(private_node_.advertise<fiber_proximity::ContactArray>("contacts", 1)),
      fibers_publisher_(private_node_.advertise<fiber_proximity::FiberArray>("fibers", 1)),
      markers_publisher_(private_node_.advertise<visualization_msgs::MarkerArray>("markers", 1)),
      statistics_publisher_(private_node_.advertise<fiber_proximity::Statistics>("statistics", 1)),
      inputs_(node_, options_.inputs, options_.timing, options_.fixed_frame,
              [this] { schedule(); }),
      diagnostics_(node_, private_node_, inputs_, detector_),
      reconfigure_server_(private_node_) {
  reconfigure_server_.setCallback([this](fiber_proximity::ProximityConfig& config,
                                         std::uint32_t /*level*/) { reconfigure(config); });
  query_server_ = private_node_.advertiseService("query", &ProximityServer::query, this);
  tick_timer_ = node_.createSteadyTimer(ros::WallDuration(tick_interval),
                                        [this](const ros::SteadyTimerEvent&) { tick(); });
  retry_timer_ = node_.createSteadyTimer(
      ros::WallDuration(retry_interval), [this](const ros::SteadyTimerEvent&) { process(); }, false,
      false);
}

ProximityServer::~ProximityServer() { queue_of(node_).removeByID(id_of(this)); }

void ProximityServer::schedule() {
  if (!std::exchange(is_scheduled_, true)) {
    queue_of(node_).addCallback(boost::make_shared<Task>([this] {
                                  is_scheduled_ = false;
                                  process();
                                }),
                                id_of(this));
  }
}

void ProximityServer::process() {
  if (inputs_.update()) {
    publish();
  }
  if (inputs_.is_waiting()) {
    retry_timer_.start();
  } else {
    retry_timer_.stop();
  }
}

void ProximityServer::tick() {
  process();
  publish_markers_if_due();
  diagnostics_.update();
}

void ProximityServer::publish() {
  detector_.set_fibers(inputs_.fibers());
  merge_time_ = inputs_.take_work_time();
  const Stopwatch stopwatch;
  if (fibers_publisher_.getNumSubscribers() > 0) {
    publish_fibers();
  }
  const bool contacts = contacts_publisher_.getNumSubscribers() > 0;
  const bool statistics = statistics_publisher_.getNumSubscribers() > 0;
  drawing_is_due_ = markers_publisher_.getNumSubscribers() > 0;
  if (!contacts && !statistics && !drawing_is_due_) {
    return;
  }
  try {
    detector_.detect(query_options_);
  } catch (const std::invalid_argument& error) {
    ROS_ERROR_STREAM_THROTTLE(1.0, "engine " << options_.engine << ": " << error.what());
    drawing_is_due_ = false;
    return;
  }
  if (contacts) {
    publish_contacts();
  }
  publish_markers_if_due();
  if (statistics) {
    publish_statistics(merge_time_ + stopwatch.seconds());
  }
}

void ProximityServer::publish_fibers() {
  to_message(inputs_.fibers(), inputs_.names(), fibers_message_);
  fibers_message_.header = inputs_.header();
  fibers_publisher_.publish(fibers_message_);
}

void ProximityServer::publish_contacts() {
  fiber_proximity::ContactArray& message = contacts_message_;
  message.header = inputs_.header();
  message.fiber_names = inputs_.names();
  const std::vector<fiber::Contact>& contacts = detector_.contacts().contacts;
  message.contacts.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    to_message(contacts[i], message.contacts[i]);
  }
  message.margin = query_options_.margin;
  message.limit_reached = detector_.contacts().limit_reached;
  message.has_minimum = detector_.minimum() != nullptr;
  message.minimum_distance = std::numeric_limits<double>::infinity();
  message.minimum = fiber_proximity::Contact();
  if (message.has_minimum) {
    message.minimum_distance = detector_.minimum()->distance;
    to_message(*detector_.minimum(), message.minimum);
  }
  message.node_tests = detector_.counts().node_tests;
  message.node_overlaps = detector_.counts().node_overlaps;
  message.primitive_tests = detector_.counts().primitive_tests;
  message.update_time = detector_.update_time();
  message.detect_time = detector_.detect_time();
  contacts_publisher_.publish(message);
}

void ProximityServer::publish_statistics(double total_time) {
  fiber_proximity::Statistics& message = statistics_message_;
  message.header = inputs_.header();
  message.engine = options_.engine;
  message.fibers = static_cast<std::uint32_t>(inputs_.fibers().fiber_count());
  message.points = static_cast<std::uint32_t>(inputs_.fibers().point_count());
  message.segments = static_cast<std::uint32_t>(inputs_.fibers().segment_count());
  message.contacts = static_cast<std::uint32_t>(detector_.contacts().contacts.size());
  message.minimum_distance = detector_.minimum() != nullptr
                                 ? detector_.minimum()->distance
                                 : std::numeric_limits<double>::infinity();
  message.merge_time = merge_time_;
  message.update_time = detector_.update_time();
  message.detect_time = detector_.detect_time();
  message.total_time = total_time;
  message.node_tests = detector_.counts().node_tests;
  message.node_overlaps = detector_.counts().node_overlaps;
  message.primitive_tests = detector_.counts().primitive_tests;
  message.inputs.clear();
  for (const std::unique_ptr<Input>& input : inputs_.inputs()) {
    message.inputs.push_back(input->statistics(ros::Time::now()));
  }
  statistics_publisher_.publish(message);
}

void ProximityServer::publish_markers_if_due() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (!drawing_is_due_ || (now - last_drawing_).toSec() * options_.marker_rate < 1.0) {
    return;
  }
  drawing_is_due_ = false;
  last_drawing_ = now;
  boxes_.clear();
  if (marker_options_.show_boxes) {
    detector_.engine().level_boxes(marker_options_.level, boxes_);
  }
  marker_builder_.build(inputs_.header(), inputs_.fibers(), detector_.contacts(),
                        detector_.minimum(), boxes_, marker_options_, markers_message_);
  markers_publisher_.publish(markers_message_);
}

bool ProximityServer::query(fiber_proximity::QueryProximity::Request& request,
                            fiber_proximity::QueryProximity::Response& response) {
  process();  // asked after a message arrived, answered with it
  try {
    if (!inputs_.is_fresh()) {
      throw std::invalid_argument(
          "no fresh input: no fibres have arrived within the input_timeout");
    }
    answer(request, detector_.engine(), inputs_.frame(), response);
    response.header = inputs_.header();
    response.fiber_names = inputs_.names();
    response.success = true;
  } catch (const std::exception& error) {
    response = fiber_proximity::QueryProximity::Response();
    response.message = error.what();
  }
  return true;
}

void ProximityServer::reconfigure(fiber_proximity::ProximityConfig& config) {
  try {
    fiber::QueryOptions options;
    options.type = fiber::query_type_from_name(config.query_type);
    options.margin = config.margin;
    options.max_contacts = static_cast<std::uint32_t>(config.max_contacts);
    options.neighbour_skip = static_cast<std::uint32_t>(config.neighbour_skip);
    options.neighbour_skip_length = config.neighbour_skip_length;
    fiber::validate(options);
    query_options_ = options;
  } catch (const std::invalid_argument& error) {
    ROS_ERROR_STREAM("parameters stay as they were: " << error.what());
    config = config_;  // the server announces what is really in use
    return;
  }
  config_ = config;
  marker_options_.show_fibers = config.show_fibers;
  marker_options_.show_contacts = config.show_contacts;
  marker_options_.show_nearest = config.show_nearest;
  marker_options_.show_boxes = config.show_boxes;
  marker_options_.level = static_cast<std::uint32_t>(config.box_level);
}

}  // namespace fiber_proximity_ros
