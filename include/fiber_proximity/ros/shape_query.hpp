#pragma once

#include "fiber_proximity/QueryProximity.h"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/ros/fixed_frame.hpp"

namespace fiber_proximity_ros {

/// Contacts of each shape of the request with the engine's fibres; fills in offsets and contacts of
/// the response.
/// @throws std::invalid_argument naming the shape, the value and what is allowed
/// @throws TransformUnavailable naming the shape and its frame
void answer(const fiber_proximity::QueryProximity::Request& request,
            const fiber::ProximityEngine& engine, const FixedFrame& frame,
            fiber_proximity::QueryProximity::Response& response);

}  // namespace fiber_proximity_ros
