#pragma once

#include <ros/node_handle.h>

#include <functional>

#include "fiber_proximity/CompareWithFcl.h"
#include "fiber_proximity/Comparison.h"
#include "fiber_proximity/compare/fcl_comparer.hpp"
#include "src/ros/detection/detected_scene.hpp"

namespace fiber_proximity_ros {

/// The node's engine beside FCL: serves ~compare, and publishes ~comparison. FCL runs when it is
/// asked to, and never else.
class ComparisonOutput {
 public:
  /// @param before_answer called before a request is answered, to take in what has arrived
  ComparisonOutput(ros::NodeHandle private_node, const DetectedScene& subject,
                   std::function<void()> before_answer);
  ComparisonOutput(const ComparisonOutput&) = delete;
  ComparisonOutput& operator=(const ComparisonOutput&) = delete;

  bool has_listeners() const { return publisher_.getNumSubscribers() > 0; }

  /// Compares and publishes. What cannot be compared is logged.
  void publish();

 private:
  bool answer(fiber_proximity::CompareWithFcl::Request& request,
              fiber_proximity::CompareWithFcl::Response& response);

  /// @throws std::exception saying why not
  fiber_proximity::Comparison compare();

  DetectedScene subject_;
  std::function<void()> before_answer_;
  fiber::FclComparer comparer_;
  ros::Publisher publisher_;
  ros::ServiceServer server_;
};

}  // namespace fiber_proximity_ros
