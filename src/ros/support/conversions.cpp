#include "fiber_proximity/ros/conversions.hpp"

#include <stdexcept>
#include <utility>

#include "fiber_proximity/query/contact.hpp"

namespace fiber_proximity_ros {

void FiberBuffer::clear() {
  header = std_msgs::Header();
  points.clear();
  offsets.assign(1, 0);
  radii.clear();
  names.clear();
  topology = {};
}

namespace {

/// Whether the fibres have these offsets and radii, and are closed and joined alike.
bool has_layout_of(const FiberBuffer& buffer, const fiber::FiberAssembly& fibers) {
  const bool are_chains = fibers.graph() == nullptr;
  if (are_chains && buffer.topology.closed.empty() && buffer.topology.joints.empty()) {
    return buffer.offsets == fibers.offsets() && buffer.radii == fibers.radii();
  }
  const fiber::FiberTopology topology = fibers.topology();
  return buffer.offsets == fibers.given_offsets() && buffer.topology.closed == topology.closed &&
         buffer.topology.joints == topology.joints && buffer.radii == fibers.given_radii();
}

/// @tparam Message of coordinates: a Point or Vector3
template <class Message>
void fill(const Eigen::Vector3d& from, Message& message) {
  message.x = from.x();
  message.y = from.y();
  message.z = from.z();
}

}  // namespace

void assign(FiberBuffer& buffer, fiber::FiberAssembly& fibers) {
  if (has_layout_of(buffer, fibers)) {
    fibers.exchange_points(buffer.points);
  } else {
    fibers = fiber::FiberAssembly(std::move(buffer.points), std::move(buffer.offsets),
                                  std::move(buffer.radii), buffer.topology);
  }
}

geometry_msgs::Point to_message(const Eigen::Vector3d& point) {
  geometry_msgs::Point message;
  fill(point, message);
  return message;
}

geometry_msgs::Vector3 to_vector_message(const Eigen::Vector3d& vector) {
  geometry_msgs::Vector3 message;
  fill(vector, message);
  return message;
}

geometry_msgs::Pose to_message(const Eigen::Isometry3d& pose) {
  const Eigen::Quaterniond rotation(pose.linear());
  geometry_msgs::Pose message;
  message.position = to_message(Eigen::Vector3d(pose.translation()));
  message.orientation.x = rotation.x();
  message.orientation.y = rotation.y();
  message.orientation.z = rotation.z();
  message.orientation.w = rotation.w();
  return message;
}

void to_message(const fiber::FiberAssembly& fibers, const std::vector<std::string>& names,
                fiber_proximity::FiberArray& message) {
  const bool are_chains = fibers.graph() == nullptr;
  message.names = names;
  message.offsets = are_chains ? fibers.offsets() : fibers.given_offsets();
  message.radii = are_chains ? fibers.radii() : fibers.given_radii();
  message.closed.clear();
  message.joints.clear();
  if (!are_chains) {
    const fiber::FiberTopology topology = fibers.topology();
    message.closed = topology.closed;
    message.joints = topology.joints;
  }
  const std::size_t fiber_count = fibers.fiber_count();
  message.points.resize(message.offsets.back());
  for (std::size_t fiber = 0; fiber < fiber_count; ++fiber) {
    const std::uint32_t shift = fibers.offsets()[fiber] - message.offsets[fiber];
    for (std::uint32_t i = message.offsets[fiber]; i < message.offsets[fiber + 1]; ++i) {
      message.points[i] = to_message(fibers.points()[i + shift]);
    }
  }
}

void to_message(const fiber::Contact& contact, std::uint8_t body_a, std::uint8_t body_b,
                fiber_proximity::Contact& message) {
  message.type_a = body_a;
  message.type_b = body_b;
  message.fiber_a = contact.fiber_a;
  message.segment_a = contact.segment_a;
  message.s = contact.s;
  message.fiber_b = contact.fiber_b;
  message.segment_b = contact.segment_b;
  message.t = contact.t;
  message.distance = contact.distance;
  message.lower = contact.lower;
  message.upper = contact.upper;
  fill(contact.point_a, message.point_a);
  fill(contact.point_b, message.point_b);
  fill(contact.normal, message.normal);
}

void add_gradients(fiber_proximity::Contact& message) {
  fiber::Contact contact;
  contact.s = message.s;
  contact.t = message.t;
  contact.normal = to_vector(message.normal);
  const fiber::GapGradient gradient = fiber::gradient_of(contact);
  message.gradients.clear();
  for (const Eigen::Vector3d& by_point : {gradient.a0, gradient.a1, gradient.b0, gradient.b1}) {
    message.gradients.push_back(to_vector_message(by_point));
  }
}

void to_message(const fiber::Crossing& crossing, fiber_proximity::Crossing& message) {
  message.fiber_a = crossing.fiber_a;
  message.segment_a = crossing.segment_a;
  message.s = crossing.s;
  message.fiber_b = crossing.fiber_b;
  message.segment_b = crossing.segment_b;
  message.t = crossing.t;
  message.a_is_over = crossing.a_is_over;
  message.sign = static_cast<std::int8_t>(crossing.sign);
  message.separation = crossing.separation;
  message.gap = crossing.gap;
  message.point_a = to_message(crossing.point_a);
  message.point_b = to_message(crossing.point_b);
}

void to_chains(const fiber_proximity::FiberArray& message, FiberBuffer& fibers) {
  fibers.clear();
  fibers.header = message.header;
  fibers.offsets = message.offsets;
  fibers.radii = message.radii;
  fibers.names = message.names;
  fibers.topology.closed = message.closed;
  fibers.topology.joints = message.joints;
  fibers.points.reserve(message.points.size());
  for (const geometry_msgs::Point& point : message.points) {
    fibers.points.push_back(to_vector(point));
  }
  if (!fibers.names.empty() && fibers.names.size() != fibers.fiber_count()) {
    throw std::invalid_argument(std::to_string(fibers.names.size()) + " names for " +
                                std::to_string(fibers.fiber_count()) +
                                " fibre(s); give one per fibre or none");
  }
}

}  // namespace fiber_proximity_ros
