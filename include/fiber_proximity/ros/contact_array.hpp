#pragma once

#include "fiber_proximity/ContactArray.h"
#include "fiber_proximity/query/options.hpp"
#include "fiber_proximity/ros/detection.hpp"

namespace fiber_proximity_ros {

/// Everything but header, names and time of the update. Memory of the message is reused.
/// @param body_b what the contacts are with: fiber_proximity::Contact::FIBER or OBJECT
void to_message(const Detection& detection, const fiber::QueryOptions& options, std::uint8_t body_b,
                fiber_proximity::ContactArray& message);

}  // namespace fiber_proximity_ros
