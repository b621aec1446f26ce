#pragma once

#include <ros/time.h>
#include <visualization_msgs/MarkerArray.h>

#include <vector>

#include "fiber_proximity/ProximityConfig.h"
#include "src/ros/detection/detected_scene.hpp"
#include "src/ros/detection/step_contacts.hpp"
#include "src/ros/outputs/answer_text.hpp"
#include "src/ros/outputs/crossings_output.hpp"
#include "src/ros/outputs/markers.hpp"
#include "src/ros/outputs/output_topic.hpp"

namespace fiber_proximity_ros {

/// The newest answer, drawn on ~markers.
class MarkerOutput {
 public:
  /// @param rate [Hz] markers are drawn at most this often
  MarkerOutput(const ros::NodeHandle& private_node, double rate, const Newcomer& on_newcomer)
      : topic_(private_node, "markers", on_newcomer), rate_(rate) {}

  bool has_listeners() const { return topic_.has_listeners(); }

  /// There is an answer to draw as soon as the rate allows, if somebody listens.
  void request() { is_requested_ = has_listeners(); }

  /// Whether publish() should be called now.
  bool is_due() const {
    return is_requested_ && (ros::SteadyTime::now() - last_time_).toSec() * rate_ >= 1.0;
  }

  /// Takes contacts of an answer: those that came and went are shown for a moment.
  void add_passed(const std::vector<StepContact>& contacts) { passed_.add(contacts); }

  /// Draws and publishes.
  /// @param completeness of contacts with fibres and with objects
  /// @param answer       what is told of in text
  void publish(const DetectedScene& subject, CrossingsOutput& crossings,
               const fiber_proximity::ProximityConfig& config, const Completeness& completeness,
               const Answer& answer);

 private:
  OutputTopic<visualization_msgs::MarkerArray> topic_;
  double rate_;  // [Hz]
  bool is_requested_ = false;
  ros::SteadyTime last_time_;
  PassedContacts passed_;
  bool has_shown_distances_ = false;  // from objects
  MarkerBuilder builder_;
  std::vector<fiber::NodeBox> boxes_;  // for their memory
};

}  // namespace fiber_proximity_ros
