#pragma once

#include "fiber_proximity/CheckFibers.h"
#include "src/ros/server/candidates.hpp"
#include "src/ros/server/query_target.hpp"

namespace fiber_proximity_ros {

/// Checks the candidates of a request, or their motions; fills in all of the response but header,
/// names and success. Candidates that the deadline comes before are not read.
/// @throws std::invalid_argument naming the candidate, the value and what is allowed
/// @throws TransformUnavailable naming the candidate and its frame
void answer(const fiber_proximity::CheckFibers::Request& request, const QueryTarget& target,
            const FindAllowed& find_allowed, fiber_proximity::CheckFibers::Response& response);

}  // namespace fiber_proximity_ros
