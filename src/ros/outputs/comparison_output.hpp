#pragma once

#include <ros/node_handle.h>

#include <functional>

#include "fiber_proximity/CompareWithFcl.h"
#include "fiber_proximity/Comparison.h"
#include "fiber_proximity/compare/fcl_comparer.hpp"
#include "src/ros/detection/detector.hpp"
#include "src/ros/inputs/input_set.hpp"

namespace fiber_proximity_ros {

/// The node's engine beside FCL: serves ~compare, and publishes ~comparison of each answer while it
/// is switched on and somebody listens. Otherwise FCL is never run.
class ComparisonOutput {
 public:
  /// What is compared, which must outlive this.
  struct Subject {
    InputSet& inputs;
    Detector& detector;  ///< knows the fibres of the inputs
    const fiber::QueryOptions& query;
    const std::string& engine;  ///< its name
  };

  /// @param before_answer called before a request is answered, to take in what has arrived
  ComparisonOutput(ros::NodeHandle& private_node, const Subject& subject,
                   std::function<void()> before_answer);
  ComparisonOutput(const ComparisonOutput&) = delete;
  ComparisonOutput& operator=(const ComparisonOutput&) = delete;

  void switch_on(bool on) { is_on_ = on; }

  /// Compares and publishes if it is on and somebody listens. What cannot be compared is logged.
  /// @returns whether it was wanted
  bool publish_if_wanted();

 private:
  bool answer(fiber_proximity::CompareWithFcl::Request& request,
              fiber_proximity::CompareWithFcl::Response& response);

  /// @throws std::exception saying why not
  fiber_proximity::Comparison compare();

  Subject subject_;
  std::function<void()> before_answer_;
  bool is_on_ = false;
  fiber::FclComparer comparer_;
  ros::Publisher publisher_;
  ros::ServiceServer server_;
};

}  // namespace fiber_proximity_ros
