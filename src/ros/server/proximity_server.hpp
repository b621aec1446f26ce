#pragma once

#include <dynamic_reconfigure/server.h>
#include <ros/node_handle.h>

#include <memory>
#include <optional>
#include <vector>

#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/ProximityConfig.h"
#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/fiber_step.hpp"
#include "src/ros/detection/knowledge.hpp"
#include "src/ros/detection/step_contacts.hpp"
#include "src/ros/inputs/input_set.hpp"
#include "src/ros/outputs/comparison_output.hpp"
#include "src/ros/outputs/contact_output.hpp"
#include "src/ros/outputs/crossings_output.hpp"
#include "src/ros/outputs/environment_output.hpp"
#include "src/ros/outputs/markers.hpp"
#include "src/ros/outputs/node_reports.hpp"
#include "src/ros/outputs/prediction_output.hpp"
#include "src/ros/server/query_services.hpp"
#include "src/ros/server/server_options.hpp"
#include "src/ros/support/clock_watch.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

/// The proximity node: fibres in, contacts, markers and answers to queries out. One class behind
/// node and nodelet; all its callbacks must come from one thread at a time.
///
/// Publishes ~contacts, ~environment_contacts, ~contact_events, ~time_to_contact, ~crossings (see
/// CrossingsOutput), ~fibers, ~markers, ~statistics, ~comparison and /diagnostics; serves ~compare,
/// and what serve_queries() and EnvironmentInputs serve. Each set of messages that have arrived
/// gives one answer, and what nobody subscribes to is not computed. An answer is given again where
/// somebody has begun to listen, where other things are unknown than before, and each ~heartbeat
/// while something is.
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
  void process(bool may_repeat = false);
  void tick();
  bool is_heartbeat_due() const;

  void answer(bool is_about_new_fibers, double time_before, const Stopwatch& stopwatch);
  void answer_about_environment();
  void take_fibers();
  Completeness completeness_of_all() const;
  void publish_statistics(double time);
  void detect();
  std::string most_contacts_of() const;
  std::optional<KnownMotion> detect_motion();
  void publish_contacts();
  void detect_in_environment();
  void publish_markers_if_due();

  void reconfigure(AskedConfig& config);

  ros::NodeHandle node_;
  ros::NodeHandle private_node_;
  ServerOptions options_;
  fiber_proximity::ProximityConfig config_;
  fiber::QueryOptions query_options_;
  MarkerOptions marker_options_;
  Detector detector_;
  std::unique_ptr<fiber::ProximityEngine> motion_engine_;
  fiber::MotionResult motion_result_;
  FiberStep step_;
  FiberState newest_state_;  // for its memory

  Newcomer newcomer_;  // before those who call it
  ContactOutput contacts_;
  ros::Publisher fibers_publisher_;
  ros::Publisher markers_publisher_;

  // Members for their memory.
  fiber_proximity::FiberArray fibers_message_;
  visualization_msgs::MarkerArray markers_message_;
  std::vector<fiber::NodeBox> boxes_;

  MarkerBuilder marker_builder_;
  EnvironmentMarkers environment_markers_;
  PassedContacts passed_;
  ros::SteadyTime last_drawing_;
  bool drawing_is_due_ = false;
  bool has_shown_distances_ = false;  // from objects
  bool is_scheduled_ = false;
  bool has_newcomers_ = false;
  ros::SteadyTime last_answer_ = ros::SteadyTime::now();

  // Last, so that they go first: callbacks come from here.
  InputSet inputs_;
  CrossingsOutput crossings_;
  EnvironmentOutput environment_;
  Knowledge knowledge_;
  Diagnostics diagnostics_;
  StatisticsOutput statistics_;
  PredictionOutput prediction_;
  ComparisonOutput comparison_;
  std::vector<ros::ServiceServer> queries_;
  dynamic_reconfigure::Server<AskedConfig> reconfigure_server_;
  ClockWatch clock_;
  ros::SteadyTimer tick_timer_;
  ros::SteadyTimer retry_timer_;
};

}  // namespace fiber_proximity_ros
