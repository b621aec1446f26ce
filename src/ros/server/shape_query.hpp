#pragma once

#include "fiber_proximity/QueryProximity.h"
#include "src/ros/server/query_target.hpp"

namespace fiber_proximity_ros {

/// Contacts of each shape of the request with the fibres, the environment or both; fills in all of
/// the response but header, names and success. Shapes that the deadline comes before are not read.
/// @throws std::invalid_argument naming the shape, the value and what is allowed
/// @throws TransformUnavailable naming the shape and its frame
void answer(const fiber_proximity::QueryProximity::Request& request, const QueryTarget& target,
            fiber_proximity::QueryProximity::Response& response);

}  // namespace fiber_proximity_ros
