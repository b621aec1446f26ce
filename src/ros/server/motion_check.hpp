#pragma once

#include "fiber_proximity/CheckFibers.h"
#include "src/ros/server/candidates.hpp"
#include "src/ros/server/query_target.hpp"

namespace fiber_proximity_ros {

/// Checks the motions of a request with waypoint_offsets; fills in what answer() does, by motion,
/// and the times. Motions that the deadline comes before are not read.
/// @throws std::invalid_argument naming the motion, its state, the value and what is allowed
/// @throws TransformUnavailable naming the motion, its state and the frame
void answer_motions(const fiber_proximity::CheckFibers::Request& request, const QueryTarget& target,
                    const FindAllowed& find_allowed,
                    fiber_proximity::CheckFibers::Response& response);

}  // namespace fiber_proximity_ros
