// Obstacles of a scene that move.
#pragma once

#include <memory>
#include <string>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// How an obstacle moves: a link of a robot as its frame of tf, others by the key `motion`, a map
/// of
///   path:   a list of {time, position, orientation, angle}, in between straight lines and turns at
///           constant rates; what is not given stays as it was, to begin with as `pose` has it
///   axis:   about which `angle` turns it, in its own frame; z if there is none
///   period: [s] after which the path begins again, to where it leads back from its last entry
///   frame:  of tf, that carries it: its pose is in this frame
/// @throws std::invalid_argument naming file, line and value, what is allowed, and the obstacle
SimMovingObstacle read_obstacle_motion(const SceneObstacle& obstacle);

/// How far the points of a bounded object are from its origin at most [m].
double reach_of(const EnvironmentObject& object);

/// @throws std::invalid_argument naming an obstacle that turns so far in a step that one cannot see
///         to which side
void require_slow_turns(const SimDescription& scene);

/// The motions of a scene's moving obstacles.
/// @param scene gets the frames that are to be followed
std::shared_ptr<ObstacleMotions> make_obstacle_motions(const SimDescription& description,
                                                       SimScene& scene);

/// Has the obstacles of a copy go on along what is known of their frames of tf now.
void copy_obstacle_frames(const SimScene& scene, SimScene& copy);

}  // namespace fiber
