#pragma once

#include <string>

#include "fiber_proximity/ProximityConfig.h"
#include "fiber_proximity/query/options.hpp"

namespace fiber_proximity_ros {

/// The query that the node's dynamic parameters ask for.
/// @throws std::invalid_argument naming the parameter, its value and what is allowed
fiber::QueryOptions to_query_options(const fiber_proximity::ProximityConfig& config);

/// As fiber::current_kernel_name(), with a warning where that is another name.
/// @param place where the name stands, for the warning
std::string current_kernel_name(const std::string& place, const std::string& name);

}  // namespace fiber_proximity_ros
