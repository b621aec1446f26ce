#include "src/ros/server/shape_query.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/naming.hpp"
#include "src/ros/server/request_options.hpp"

namespace fiber_proximity_ros {
namespace {

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
  fiber::FiberAssembly assembly(points, {0, static_cast<std::uint32_t>(points.size())},
                                {shape.radius});
  std_msgs::Header header = shape.header;
  if (header.frame_id.empty()) {
    header.frame_id = frame.name();
  }
  frame.place(header, assembly, points);
  return assembly;
}

/// Asks about one shape. Objects are numbered after the fibres.
class ShapeQuery {
 public:
  ShapeQuery(const QueryTarget& target, std::uint8_t against)
      : target_(target),
        with_fibers_(against != QueryProximity::Request::ENVIRONMENT),
        with_environment_(against != QueryProximity::Request::FIBERS),
        fiber_count_(static_cast<std::uint32_t>(target.fibers.fiber_count())) {}

  void ask(const fiber::FiberAssembly& shape, const fiber::QueryOptions& options) {
    if (!with_environment_) {
      target_.engine->query_shape(shape, options, result_);
      return;
    }
    target_.environment.query(shape, options, {}, result_);
    for (fiber::Contact& contact : result_.contacts) {
      contact.fiber_b += fiber_count_;
    }
    if (with_fibers_) {
      target_.engine->query_shape(shape, options, of_fibers_);
      fiber::merge_results(options, of_fibers_, result_);
    }
  }

  const fiber::QueryResult& result() const { return result_; }

  void append_contacts(std::uint32_t shape, QueryProximity::Response& response) const {
    for (const fiber::Contact& contact : result_.contacts) {
      const bool is_object = contact.fiber_b >= fiber_count_;
      fiber_proximity::Contact message;
      to_message(contact, fiber_proximity::Contact::SHAPE,
                 is_object ? fiber_proximity::Contact::OBJECT : fiber_proximity::Contact::FIBER,
                 message);
      message.fiber_a = shape;
      message.fiber_b -= is_object ? fiber_count_ : 0;
      response.contacts.push_back(message);
    }
    response.offsets.push_back(static_cast<std::uint32_t>(response.contacts.size()));
  }

 private:
  const QueryTarget& target_;
  bool with_fibers_;
  bool with_environment_;
  std::uint32_t fiber_count_;
  fiber::QueryResult result_;
  fiber::QueryResult of_fibers_;
};

}  // namespace

void answer(const QueryProximity::Request& request, const QueryTarget& target,
            QueryProximity::Response& response) {
  fiber::QueryOptions options = validated_options(request, target.defaults);
  ShapeQuery query(target, request.against);
  const std::size_t count = request.shapes.size();
  response.complete = true;
  response.offsets.reserve(count + 1);
  response.minimum_lower.reserve(count);
  response.offsets.push_back(0);
  for (std::uint32_t i = 0; i < count && !target.is_time_up(); ++i) {
    options.deadline = target.time_for_query();
    options.contact_limit =
        share_of_contacts(target.defaults.contact_limit, response.contacts.size(), 1);
    naming("shape " + std::to_string(i),
           [&] { query.ask(to_assembly(request.shapes[i], target.frame), options); });
    query.append_contacts(i, response);
    response.minimum_lower.push_back(query.result().minimum_lower());
    response.complete = response.complete && query.result().complete;
    response.limit_reached = response.limit_reached || query.result().limit_reached;
  }
  // Of the shapes that the deadline came before nothing is known.
  response.complete = response.complete && response.minimum_lower.size() == count;
  response.offsets.resize(count + 1, response.offsets.back());
  response.minimum_lower.resize(count, -std::numeric_limits<double>::infinity());
  if (request.gradients) {
    std::for_each(response.contacts.begin(), response.contacts.end(), add_gradients);
  }
}

}  // namespace fiber_proximity_ros
