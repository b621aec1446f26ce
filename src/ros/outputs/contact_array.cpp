#include "src/ros/outputs/contact_array.hpp"

#include <algorithm>
#include <limits>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/fiber_step.hpp"

namespace fiber_proximity_ros {

namespace {

using std::chrono::nanoseconds;

/// What is known of it over time.
void add_details(const StepContact& contact, const fiber::Touch& touch, nanoseconds since,
                 nanoseconds now, fiber_proximity::Contact& message) {
  message.id = touch.id;
  message.age =
      std::chrono::duration<double>(std::max(now - touch.began.upper, nanoseconds(0))).count();
  message.time_lower = to_stamp(std::max(contact.first.lower, since));
  message.time_upper = to_stamp(contact.first.upper);
  message.gone = contact.state != StepContact::State::THERE;
}

/// Derivatives, or none, whatever the message had before.
void set_gradients(bool are_wanted, fiber_proximity::Contact& message) {
  message.gradients.clear();
  if (are_wanted) {
    add_gradients(message);
  }
}

}  // namespace

void to_message(const Detection& detection, const TrackedContacts& tracked,
                const fiber::QueryOptions& options, std::uint8_t body_b,
                const std_msgs::Header& header, fiber_proximity::ContactArray& message) {
  const nanoseconds now = to_time(header.stamp);
  message.header = header;
  message.since = to_stamp(tracked.since);
  message.contacts.resize(tracked.contacts.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < tracked.contacts.size(); ++i) {
    const StepContact& contact = tracked.contacts[i];
    if (contact.state != StepContact::State::LEFT) {
      fiber_proximity::Contact& of_message = message.contacts[count++];
      to_message(contact.contact, fiber_proximity::Contact::FIBER, body_b, of_message);
      add_details(contact, tracked.touches.touch_of(i), tracked.since, now, of_message);
      set_gradients(tracked.has_gradients, of_message);
    }
  }
  message.contacts.resize(count);
  message.margin = options.margin;
  message.limit_reached = detection.is_limit_reached();
  message.has_minimum = detection.minimum() != nullptr;
  message.minimum_distance = std::numeric_limits<double>::infinity();
  message.minimum = fiber_proximity::Contact();
  if (message.has_minimum) {
    message.minimum_distance = detection.minimum()->distance;
    to_message(*detection.minimum(), fiber_proximity::Contact::FIBER, body_b, message.minimum);
    set_gradients(tracked.has_gradients, message.minimum);
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
