#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/environment/scene/mesh_files.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/yaml/yaml_field.hpp"
#include "src/environment/allowed_contacts.hpp"

namespace fiber {

/// An object around the fibres, and the frame that its pose is in.
struct SceneObstacle {
  std::string frame_id;  ///< empty: that of the fibres
  EnvironmentObject object;
};

/// What is around the fibres from the start.
struct EnvironmentScene {
  std::vector<SceneObstacle> obstacles;  ///< each with a name of its own
  std::vector<NamedPair> allowed;
};

/// Reads the lists `obstacles` and `allowed` of a YAML document, whose fields are those of the
/// messages Obstacle and AllowedPair, but `frame_id` stands for the header; vectors are lists of
/// three numbers, quaternions of four, x y z w. Primitives have the names box, sphere, cylinder or
/// cone as type; meshes may be `{resource: file:///..., scale: [1, 1, 1]}`.
/// @throws std::invalid_argument naming file, line, field and value, or the obstacle, and what is
///         allowed
EnvironmentScene read_environment_scene(const YamlField& document, const MeshSource& meshes);

}  // namespace fiber
