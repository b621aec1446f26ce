#pragma once

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/ros/fixed_frame.hpp"

namespace fiber_proximity_ros {

/// What services ask about. Holds references: only for the call.
struct QueryTarget {
  const fiber::FiberAssembly& fibers;
  const fiber::ProximityEngine& engine;  ///< updated to the fibres
  const fiber::Environment& environment;
  const FixedFrame& frame;
  const fiber::QueryOptions& defaults;  ///< what a request leaves open
};

}  // namespace fiber_proximity_ros
