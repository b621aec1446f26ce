#pragma once

#include <string>

#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/environment/world.hpp"

namespace fiber_proximity_ros {

/// Names that obstacles may not have, as the node itself uses them.
inline const std::string cloud_name = "cloud";
inline const std::string robot_prefix = "robot/";  ///< followed by the name of a link

/// @throws std::invalid_argument for an empty name, or one of those above
void validate_obstacle_name(const std::string& name);

/// What a message asks for, as a change of the world, but in the message's frame. A REMOVE of an
/// empty id, which means all obstacles, is left to those who know them.
/// @throws std::invalid_argument naming the obstacle, what is wrong with it and what is allowed
fiber::ObjectChange to_change(const fiber_proximity::Obstacle& obstacle);

}  // namespace fiber_proximity_ros
