#pragma once

#include <string>

#include "fiber_proximity/query/options.hpp"
#include "src/ros/server/asked_config.hpp"

namespace fiber_proximity_ros {

/// The parameter `accuracy` stands for kernel, tolerances and deadline: it overrides what these ask
/// for, unless it is custom, or deadline while there is no deadline.
/// @param options that the other parameters ask for
/// @throws std::invalid_argument for an unknown accuracy, listing the known ones
void apply_accuracy(const std::string& accuracy, fiber::QueryOptions& options);

/// Tells a user about this parameter: that it overrides some of the others although they
/// have been set, such as "overrides kernel exact, tolerance 0.001; accuracy custom uses them", or
/// that it has no effect. Empty if there is nothing to tell.
/// @param options after apply_accuracy()
std::string accuracy_problem(const AskedConfig& config, const fiber::QueryOptions& options);

}  // namespace fiber_proximity_ros
