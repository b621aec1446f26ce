#pragma once

#include "fiber_proximity/AllowedPair.h"
#include "fiber_proximity/Obstacle.h"
#include "fiber_proximity/ros/mesh_loader.hpp"
#include "fiber_proximity/ros/yaml_field.hpp"

namespace fiber_proximity_ros {

/// Entries of a scene as the messages they stand for; what the values mean is checked with these.
/// @throws std::invalid_argument as YamlField and MeshLoader
fiber_proximity::Obstacle read_obstacle(const YamlField& entry, const MeshLoader& meshes);
fiber_proximity::AllowedPair read_allowed_pair(const YamlField& entry);

}  // namespace fiber_proximity_ros
