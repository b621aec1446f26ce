#pragma once

#include <ros/node_handle.h>

#include <vector>

#include "src/ros/detection/observed_scene.hpp"
#include "src/ros/server/answer_pipeline.hpp"
#include "src/ros/server/measure_service.hpp"
#include "src/ros/server/server_options.hpp"
#include "src/ros/server/settings.hpp"
#include "src/ros/support/clock_watch.hpp"

namespace fiber_proximity_ros {

/// The proximity node: fibres in, contacts, markers and answers to queries out. One class behind
/// node and nodelet; all its callbacks must come from one thread at a time.
///
/// Publishes ~contacts, ~environment_contacts, ~contact_events, ~time_to_contact, ~crossings (see
/// CrossingsOutput), ~fibers, ~markers, ~statistics, ~comparison and /diagnostics; serves ~compare,
/// and what serve_queries(), MeasureService and EnvironmentInputs serve. Each set of messages that
/// have arrived gives one answer (see AnswerPipeline). An answer is given again where somebody has
/// begun to listen, where other things are unknown than before, and each ~heartbeat while something
/// is.
class ProximityServer {
 public:
  /// @throws std::invalid_argument for a bad parameter (see read_server_options) or an unknown
  ///         engine: there is nothing sensible to run then
  ProximityServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node);
  ~ProximityServer();
  ProximityServer(const ProximityServer&) = delete;
  ProximityServer& operator=(const ProximityServer&) = delete;

 private:
  /// Has process() called after the callbacks that are in the queue already, so that messages that
  /// have arrived together are answered together.
  void schedule();

  /// Takes in what has arrived and answers.
  /// @param may_repeat whether the last answer is to be given again where that is due
  void process(bool may_repeat = false);
  void tick();
  bool is_heartbeat_due() const;

  ros::NodeHandle node_;
  ServerOptions options_;
  bool is_scheduled_ = false;
  bool has_newcomers_ = false;
  ros::SteadyTime last_answer_ = ros::SteadyTime::now();
  Settings settings_;

  // Last, so that they go first: callbacks come from here.
  ObservedScene scene_;
  AnswerPipeline pipeline_;
  std::vector<ros::ServiceServer> queries_;
  MeasureService measure_service_;
  ClockWatch clock_;
  ros::SteadyTimer tick_timer_;
  ros::SteadyTimer retry_timer_;
};

}  // namespace fiber_proximity_ros
