#include "src/ros/server/query_services.hpp"

#include <algorithm>
#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/QueryProximity.h"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/detection/environment_detector.hpp"
#include "src/ros/detection/uncertainty.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/server/check_service.hpp"
#include "src/ros/server/query_options.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::CheckFibers;
using fiber_proximity::QueryProximity;
using fiber_proximity::QueryShape;

fiber::QueryOptions validated_options(const QueryProximity::Request& request,
                                      const fiber::QueryOptions& defaults) {
  fiber::QueryOptions options = to_options(request, defaults);
  options.tolerance = request.tolerance;
  options.relative_tolerance = request.relative_tolerance;
  fiber::validate(options);
  if (request.against > QueryProximity::Request::EVERYTHING) {
    throw std::invalid_argument("against is " + std::to_string(request.against) +
                                ", it must be 0 (FIBERS), 1 (ENVIRONMENT) or 2 (EVERYTHING)");
  }
  return options;
}

fiber::FiberAssembly to_assembly(const QueryShape& shape, const FixedFrame& frame) {
  if (shape.points.empty()) {
    throw std::invalid_argument("has no points, it needs at least 1");
  }
  std::vector<Eigen::Vector3d> points;
  for (const geometry_msgs::Point& point : shape.points) {
    points.push_back(to_vector(point));
  }
  if (points.size() == 1) {
    points.push_back(points.front());  // a sphere is a capsule of no length
  }
  const auto count = static_cast<std::uint32_t>(points.size());
  fiber::FiberAssembly assembly(std::move(points), {0, count}, {shape.radius});
  std_msgs::Header header = shape.header;
  if (header.frame_id.empty()) {
    header.frame_id = frame.name();
  }
  frame.place(header, assembly);
  return assembly;
}

/// Asks about one shape. Objects are numbered after the fibres.
/// @param of_fibers for its memory
void query_shape(const QueryTarget& target, std::uint8_t against, const fiber::FiberAssembly& shape,
                 const fiber::QueryOptions& options, fiber::QueryResult& of_fibers,
                 fiber::QueryResult& result) {
  const Uncertainty uncertainty(target.scene.fibers.uncertainties(), Uncertainty::Bodies::B);
  const auto query_fibers = [&](fiber::QueryResult& found) {
    query_possible(
        options, uncertainty,
        [&](const fiber::QueryOptions& asked, fiber::QueryResult& answered) {
          target.engine->query_shape(shape, asked, answered);
        },
        found);
  };
  if (against == QueryProximity::Request::FIBERS) {
    query_fibers(result);
    return;
  }
  target.environment.query(shape, options, {}, result);
  for (fiber::Contact& contact : result.contacts) {
    contact.fiber_b += static_cast<std::uint32_t>(target.fibers.fiber_count());
  }
  if (against == QueryProximity::Request::EVERYTHING) {
    query_fibers(of_fibers);
    fiber::merge_results(options, of_fibers, result);
  }
}

void append_contacts(const fiber::QueryResult& result, double margin, std::uint32_t shape,
                     std::uint32_t fiber_count, QueryProximity::Response& response) {
  for (const fiber::Contact& contact : result.contacts) {
    const bool is_object = contact.fiber_b >= fiber_count;
    fiber_proximity::Contact& message = response.contacts.emplace_back();
    to_message(contact, fiber_proximity::Contact::SHAPE,
               is_object ? fiber_proximity::Contact::OBJECT : fiber_proximity::Contact::FIBER,
               message);
    message.certain = is_certain(contact, margin);
    message.fiber_a = shape;
    message.fiber_b -= is_object ? fiber_count : 0;
  }
  response.offsets.push_back(static_cast<std::uint32_t>(response.contacts.size()));
}

/// How completely the bodies are known that a request is about.
Completeness known_around(std::uint8_t against, const Knowledge& knowledge) {
  using About = Knowledge::About;
  switch (against) {
    case QueryProximity::Request::FIBERS:
      return knowledge.completeness(About::FIBERS, true);
    case QueryProximity::Request::ENVIRONMENT:
      return knowledge.completeness(About::ENVIRONMENT, true);
    default:
      return knowledge.completeness(About::FIBERS_AND_ENVIRONMENT, true);
  }
}

/// Contacts of each shape of the request with the fibres, the environment or both; fills in all of
/// the response but header, names and success. Shapes that the deadline comes before are not read.
/// @throws std::invalid_argument naming the shape, the value and what is allowed
/// @throws TransformUnavailable naming the shape and its frame
void answer(const QueryProximity::Request& request, const QueryTarget& target,
            QueryProximity::Response& response) {
  fiber::QueryOptions options = validated_options(request, target.defaults);
  fiber::QueryResult of_fibers;
  fiber::QueryResult result;
  const std::size_t count = request.shapes.size();
  Completeness known = known_around(request.against, target.scene.knowledge);
  const double nothing_known = -std::numeric_limits<double>::infinity();
  bool is_cut_off = false;
  response.offsets.reserve(count + 1);
  response.minimum_lower.reserve(count);
  response.offsets.push_back(0);
  for (std::uint32_t i = 0; i < count && !target.is_time_up(); ++i) {
    options.deadline = target.time_for_query();
    options.contact_limit =
        share_of_contacts(target.defaults.contact_limit, response.contacts.size(), 1);
    naming("shape " + std::to_string(i), [&] {
      query_shape(target, request.against,
                  to_assembly(request.shapes[i], target.scene.fibers.frame()), options, of_fibers,
                  result);
    });
    append_contacts(result, options.margin, i,
                    static_cast<std::uint32_t>(target.fibers.fiber_count()), response);
    response.minimum_lower.push_back(known.lower(result.minimum_lower(), nothing_known));
    is_cut_off = is_cut_off || !result.complete;
    response.limit_reached = response.limit_reached || result.limit_reached;
  }
  // Nothing is known of the shapes that the deadline came before.
  if (is_cut_off || response.minimum_lower.size() < count) {
    options.deadline = request.deadline;
    known.add_cut_off(cut_off_text("pairs of shapes", options));
  }
  response.complete = known.is_complete();
  response.unknown = known.unknown();
  response.offsets.resize(count + 1, response.offsets.back());
  response.minimum_lower.resize(count, nothing_known);
  if (request.gradients) {
    std::for_each(response.contacts.begin(), response.contacts.end(), add_gradients);
  }
}

/// Answers a request about what there is now, or says why it cannot.
template <class Request, class Response, class Answer>
bool respond(const DetectedScene& subject, const std::function<void()>& before_answer,
             const Request& request, bool asks_about_fibers, Response& response,
             const Answer& answer_it) {
  const fiber::Deadline deadline(request.deadline);
  before_answer();  // asked after a message arrived, answered with it
  try {
    InputSet& fibers = subject.scene.fibers;
    if (asks_about_fibers) {
      fibers.require_fresh();
    }
    const std::shared_ptr<const fiber::Environment> environment =
        subject.scene.environment.environment();
    const fiber::FiberAssembly& merged = fibers.fibers();
    const QueryTarget target{
        subject.scene, merged,        asks_about_fibers ? &subject.detector.engine() : nullptr,
        *environment,  subject.query, deadline};
    subject.threads.execute([&] { answer_it(target); });
    response.header = fibers.header();
    if (!asks_about_fibers || !fibers.is_fresh()) {
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

}  // namespace

std::vector<ros::ServiceServer> serve_queries(ros::NodeHandle private_node,
                                              const DetectedScene& subject,
                                              const std::function<void()>& before_answer) {
  using Query = boost::function<bool(QueryProximity::Request&, QueryProximity::Response&)>;
  const Query query = [=](const auto& request, auto& response) {
    return respond(subject, before_answer, request,
                   request.against != QueryProximity::Request::ENVIRONMENT, response,
                   [&](const QueryTarget& target) { answer(request, target, response); });
  };
  using Check = boost::function<bool(CheckFibers::Request&, CheckFibers::Response&)>;
  const Check check = [=](const auto& request, auto& response) {
    return respond(subject, before_answer, request, request.ignore_fibers == 0, response,
                   [&](const QueryTarget& target) { answer(request, target, response); });
  };
  return {private_node.advertiseService("query", query),
          private_node.advertiseService("check_fibers", check)};
}

}  // namespace fiber_proximity_ros
