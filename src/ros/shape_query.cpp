#include "fiber_proximity/ros/shape_query.hpp"

#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::QueryProximity;
using fiber_proximity::QueryShape;

fiber::QueryOptions to_options(const QueryProximity::Request& request) {
  fiber::QueryOptions options;
  switch (request.type) {
    case QueryProximity::Request::FIRST:
      options.type = fiber::QueryType::FIRST;
      break;
    case QueryProximity::Request::CLOSEST:
      options.type = fiber::QueryType::CLOSEST;
      break;
    case QueryProximity::Request::LIMITED:
      options.type = fiber::QueryType::LIMITED;
      break;
    case QueryProximity::Request::ALL:
      options.type = fiber::QueryType::ALL;
      break;
    case QueryProximity::Request::FIBER_PAIRS:
      options.type = fiber::QueryType::FIBER_PAIRS;
      break;
    default:
      throw std::invalid_argument("type is " + std::to_string(request.type) +
                                  ", it must be 0 (FIRST), 1 (CLOSEST), 2 (LIMITED), 3 (ALL) or 4 "
                                  "(FIBER_PAIRS)");
  }
  options.margin = request.margin;
  options.max_contacts = request.max_contacts;
  fiber::validate(options);
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
  fiber::FiberAssembly assembly(points, {0, static_cast<std::uint32_t>(points.size())},
                                {shape.radius});
  std_msgs::Header header = shape.header;
  if (header.frame_id.empty()) {
    header.frame_id = frame.name();
  }
  frame.place(header, assembly, points);
  return assembly;
}

void append_contacts(const fiber::QueryResult& result, std::uint32_t shape,
                     QueryProximity::Response& response) {
  for (const fiber::Contact& contact : result.contacts) {
    fiber_proximity::Contact message;
    to_message(contact, message);
    message.type_a = fiber_proximity::Contact::SHAPE;
    message.fiber_a = shape;
    response.contacts.push_back(message);
  }
  response.offsets.push_back(static_cast<std::uint32_t>(response.contacts.size()));
}

}  // namespace

void answer(const QueryProximity::Request& request, const fiber::ProximityEngine& engine,
            const FixedFrame& frame, QueryProximity::Response& response) {
  const fiber::QueryOptions options = to_options(request);
  fiber::QueryResult result;
  response.offsets.push_back(0);
  for (std::uint32_t i = 0; i < request.shapes.size(); ++i) {
    const std::string shape = "shape " + std::to_string(i) + ": ";
    try {
      engine.query_shape(to_assembly(request.shapes[i], frame), options, result);
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(shape + error.what());
    } catch (const TransformUnavailable& error) {
      throw TransformUnavailable(shape + error.what());
    }
    append_contacts(result, i, response);
  }
}

}  // namespace fiber_proximity_ros
