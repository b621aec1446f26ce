#pragma once

#include <ros/node_handle.h>

#include <functional>

#include "fiber_proximity/CheckFibers.h"
#include "fiber_proximity/QueryProximity.h"
#include "src/ros/environment/environment_inputs.hpp"
#include "src/ros/inputs/input_set.hpp"
#include "src/ros/outputs/detector.hpp"

namespace fiber_proximity_ros {

/// Serves ~query and ~check_fibers. What asks about the environment alone is answered without any
/// fibres, too.
class QueryServices {
 public:
  /// What is asked about, which must outlive this.
  struct Subject {
    InputSet& fibers;
    Detector& detector;  ///< knows the fibres of the inputs
    const EnvironmentInputs& environment;
    const fiber::QueryOptions& defaults;
  };

  /// @param before_answer called before a request is answered, to take in what has arrived
  QueryServices(ros::NodeHandle private_node, const Subject& subject,
                std::function<void()> before_answer);
  QueryServices(const QueryServices&) = delete;
  QueryServices& operator=(const QueryServices&) = delete;

 private:
  template <class Request, class Response, class Answer>
  bool respond(const Request& request, bool asks_about_fibers, Response& response,
               const Answer& answer_it);
  bool query(fiber_proximity::QueryProximity::Request& request,
             fiber_proximity::QueryProximity::Response& response);
  bool check_fibers(fiber_proximity::CheckFibers::Request& request,
                    fiber_proximity::CheckFibers::Response& response);

  Subject subject_;
  std::function<void()> before_answer_;
  ros::ServiceServer query_server_;
  ros::ServiceServer check_server_;
};

}  // namespace fiber_proximity_ros
