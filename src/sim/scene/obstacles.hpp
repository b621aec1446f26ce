// The obstacles of a scene, those that stand and those that move.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// Reads the obstacles of a scene, which are all in its frame.
/// @param scene with its effects; gets the obstacles
/// @returns what may touch, by names
/// @throws std::invalid_argument naming file, line and value, and what is allowed
EnvironmentScene read_environment(const std::optional<YamlField>& field, const MeshSource& meshes,
                                  const LinkSource& links, SimDescription& scene);

/// All obstacles as the scene begins, those that move behind the others; without those that follow
/// frames of tf, which are nowhere yet.
std::shared_ptr<const Environment> environment_at_start(const SimDescription& scene);

/// Makes sure that no fibre is inside of an object that appears: no side would be the right one.
/// @throws std::invalid_argument naming fibre, segment and how deep it is in the object
void require_room(const SimDescription& description, const SimScene& scene,
                  const EnvironmentObject& object);

/// Adds an obstacle to a scene that runs, whatever is there: it stands until it is moved.
/// @throws std::invalid_argument for an object that is not valid, or if nothing would touch it
void add_obstacle(SimScene& scene, const EnvironmentObject& object);

/// Among the obstacles that were added; null if it is none.
const AddedObstacle* find_added(const SimScene& scene, const std::string& name);

/// Where an obstacle that was added is, with its shapes.
EnvironmentObject placed(const SimScene& scene, const AddedObstacle& obstacle);

/// Has an obstacle that was added go somewhere, straight and turning at a constant rate.
/// @param duration that it takes from now on [s]
void move_obstacle(const SimScene& scene, const AddedObstacle& obstacle,
                   const Eigen::Isometry3d& pose, double duration);

/// Gives an obstacle that was added other shapes; it goes on along its way.
void replace_shapes(SimScene& scene, const AddedObstacle& obstacle,
                    const std::vector<PlacedShape>& shapes);

/// Removes an obstacle that was added.
void remove_obstacle(SimScene& scene, const AddedObstacle& obstacle);

/// Gives a copy of a scene the obstacles that were added to that.
void copy_added_obstacles(const SimScene& scene, SimScene& copy);

}  // namespace fiber
