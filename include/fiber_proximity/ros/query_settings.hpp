#pragma once

#include "fiber_proximity/ProximityConfig.h"
#include "fiber_proximity/query/options.hpp"

namespace fiber_proximity_ros {

/// The query that the node's dynamic parameters ask for.
/// @throws std::invalid_argument naming the parameter, its value and what is allowed
fiber::QueryOptions to_query_options(const fiber_proximity::ProximityConfig& config);

}  // namespace fiber_proximity_ros
