#pragma once

#include <moveit_msgs/CollisionObject.h>

#include "fiber_proximity/Obstacle.h"

namespace fiber_proximity_ros {

/// The obstacle with the same name, shapes and poses, and the same operation. What it holds is
/// validated where it is applied. The stamp is left out: MoveIt, too, places objects by where their
/// frames are when the message comes. Subframes and the type have no counterpart.
fiber_proximity::Obstacle to_obstacle(const moveit_msgs::CollisionObject& object);

}  // namespace fiber_proximity_ros
