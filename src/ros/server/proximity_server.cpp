#include "src/ros/server/proximity_server.hpp"

#include <utility>

#include "src/ros/server/make_proximity_server.hpp"
#include "src/ros/server/query_services.hpp"
#include "src/ros/support/callback_task.hpp"

namespace fiber_proximity_ros {
namespace {

/// [s] How often what needs no message is looked after: expired inputs, diagnostics, late markers.
constexpr double tick_interval = 0.1;

/// [s] How often a message that waits for its transform is tried again.
constexpr double retry_interval = 0.005;

}  // namespace

std::shared_ptr<void> make_proximity_server(const ros::NodeHandle& node,
                                            const ros::NodeHandle& private_node) {
  return std::make_shared<ProximityServer>(node, private_node);
}

ProximityServer::ProximityServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node)
    : node_(node),
      options_(read_server_options(node, private_node)),
      settings_(private_node, options_.config),
      scene_(node, private_node, options_.fibers, settings_.query(), [this] { schedule(); }),
      pipeline_(
          node, private_node, options_, settings_, scene_, [this] { has_newcomers_ = true; },
          [this] { process(); }),
      queries_(serve_queries(private_node, pipeline_.detected(), [this] { process(); })),
      measure_service_(private_node, options_.engine),
      tick_timer_(node_.createSteadyTimer(ros::WallDuration(tick_interval),
                                          [this](const ros::SteadyTimerEvent&) { tick(); })),
      retry_timer_(node_.createSteadyTimer(
          ros::WallDuration(retry_interval), [this](const ros::SteadyTimerEvent&) { process(); },
          false, false)) {}

ProximityServer::~ProximityServer() { remove_tasks(queue_of(node_), this); }

void ProximityServer::schedule() {
  if (!std::exchange(is_scheduled_, true)) {
    add_task(queue_of(node_), this, [this] {
      is_scheduled_ = false;
      process();
    });
  }
}

void ProximityServer::process(bool may_repeat) {
  const double time_before = scene_.fibers.take_work_time();
  const Stopwatch stopwatch;
  const ObservedScene::Changes changes = scene_.update();
  const bool repeats = may_repeat && (has_newcomers_ || is_heartbeat_due());
  if (changes.fibers || changes.knowledge || repeats) {
    last_answer_ = ros::SteadyTime::now();
    const bool has_newcomers = std::exchange(has_newcomers_, false);
    const bool shows_fibers = changes.fibers || (has_newcomers && scene_.fibers.is_fresh());
    pipeline_.answer({changes.fibers, shows_fibers, time_before, stopwatch});
  } else if (changes.environment && scene_.fibers.is_fresh()) {
    pipeline_.answer_about_environment();
  }
  measure_service_.offer(scene_.fibers.message(), settings_.query());
  if (scene_.is_waiting()) {
    retry_timer_.start();
  } else {
    retry_timer_.stop();
  }
}

void ProximityServer::tick() {
  clock_.look();
  process(true);
  pipeline_.tick();
}

bool ProximityServer::is_heartbeat_due() const {
  return options_.heartbeat > 0.0 && !scene_.knowledge.is_all_known() &&
         (ros::SteadyTime::now() - last_answer_).toSec() >= options_.heartbeat;
}

}  // namespace fiber_proximity_ros
