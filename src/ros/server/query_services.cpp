#include "src/ros/server/query_services.hpp"

#include <exception>
#include <memory>
#include <utility>

#include "src/ros/outputs/environment_output.hpp"
#include "src/ros/server/check_service.hpp"
#include "src/ros/server/shape_query.hpp"

namespace fiber_proximity_ros {

using fiber_proximity::CheckFibers;
using fiber_proximity::QueryProximity;

QueryServices::QueryServices(ros::NodeHandle private_node, const Subject& subject,
                             std::function<void()> before_answer)
    : subject_(subject),
      before_answer_(std::move(before_answer)),
      query_server_(private_node.advertiseService("query", &QueryServices::query, this)),
      check_server_(
          private_node.advertiseService("check_fibers", &QueryServices::check_fibers, this)) {}

/// Answers a request about what there is now, or says why it cannot.
template <class Request, class Response, class Answer>
bool QueryServices::respond(const Request& request, bool asks_about_fibers, Response& response,
                            const Answer& answer_it) {
  const fiber::Deadline deadline(request.deadline);
  before_answer_();  // asked after a message arrived, answered with it
  try {
    InputSet& fibers = subject_.fibers;
    if (asks_about_fibers) {
      fibers.require_fresh();
    }
    const std::shared_ptr<const fiber::Environment> environment =
        subject_.environment.environment();
    const fiber::FiberAssembly& merged = fibers.fibers();
    answer_it(QueryTarget{merged, fibers.names(),
                          asks_about_fibers ? &subject_.detector.engine() : nullptr, *environment,
                          fibers.frame(), subject_.defaults, deadline});
    response.header = fibers.header();
    if (!fibers.is_fresh()) {
      response.header.frame_id = fibers.frame().name();
      response.header.stamp = ros::Time::now();
    }
    response.fiber_names = fibers.names();
    response.object_names = object_names(*environment);
    response.success = true;
  } catch (const std::exception& error) {
    response = Response();
    response.message = error.what();
  }
  return true;
}

bool QueryServices::query(QueryProximity::Request& request, QueryProximity::Response& response) {
  const bool asks_about_fibers = request.against != QueryProximity::Request::ENVIRONMENT;
  return respond(request, asks_about_fibers, response,
                 [&](const QueryTarget& target) { answer(request, target, response); });
}

bool QueryServices::check_fibers(CheckFibers::Request& request, CheckFibers::Response& response) {
  return respond(request, request.ignore_fibers == 0, response, [&](const QueryTarget& target) {
    const auto allowed = [this](const std::vector<std::string>& names) {
      return subject_.environment.allowed(names);
    };
    answer(request, target, allowed, response);
  });
}

}  // namespace fiber_proximity_ros
