#include "fiber_proximity/ros/contact_array.hpp"

#include <limits>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {

void to_message(const Detection& detection, const fiber::QueryOptions& options, std::uint8_t body_b,
                fiber_proximity::ContactArray& message) {
  const std::vector<fiber::Contact>& contacts = detection.contacts().contacts;
  message.contacts.resize(contacts.size());
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    to_message(contacts[i], fiber_proximity::Contact::FIBER, body_b, message.contacts[i]);
  }
  message.margin = options.margin;
  message.limit_reached = detection.is_limit_reached();
  message.has_minimum = detection.minimum() != nullptr;
  message.minimum_distance = std::numeric_limits<double>::infinity();
  message.minimum = fiber_proximity::Contact();
  if (message.has_minimum) {
    message.minimum_distance = detection.minimum()->distance;
    to_message(*detection.minimum(), fiber_proximity::Contact::FIBER, body_b, message.minimum);
  }
  message.minimum_lower = detection.minimum_lower();
  message.minimum_upper = detection.minimum_upper();
  message.kernel = name_of(options.kernel);
  message.tolerance = options.tolerance;
  message.complete = detection.is_complete();
  message.node_tests = detection.counts().node_tests;
  message.node_overlaps = detection.counts().node_overlaps;
  message.primitive_tests = detection.counts().primitive_tests;
  message.detect_time = detection.contact_time() + detection.minimum_time();
}

}  // namespace fiber_proximity_ros
