#pragma once

#include <chrono>
#include <vector>

#include "fiber_proximity/ContactArray.h"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/outputs/contact_events.hpp"
#include "src/ros/outputs/detection.hpp"
#include "src/ros/outputs/step_contacts.hpp"

namespace fiber_proximity_ros {

/// Contacts of an answer, and what is known of them over time.
struct TrackedContacts {
  const std::vector<StepContact>& contacts;
  const ContactEvents& touches;    ///< that have tracked these
  std::chrono::nanoseconds since;  ///< the answer covers the time from this on
  bool has_gradients;              ///< whether derivatives are asked for
};

/// Everything but names, continuous, and time of the update. Memory of the message is reused.
/// @param body_b what the contacts are with: fiber_proximity::Contact::FIBER or OBJECT
void to_message(const Detection& detection, const TrackedContacts& tracked,
                const fiber::QueryOptions& options, std::uint8_t body_b,
                const std_msgs::Header& header, fiber_proximity::ContactArray& message);

}  // namespace fiber_proximity_ros
