#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <string>
#include <vector>

#include "fiber_proximity/AllowedPair.h"
#include "fiber_proximity/ros/mesh_loader.hpp"
#include "fiber_proximity/ros/obstacle_set.hpp"
#include "fiber_proximity/ros/yaml_field.hpp"

namespace fiber_proximity_ros {

/// What is there from the start.
struct EnvironmentScene {
  std::vector<FramedChange> obstacles;  ///< all to be added
  std::vector<fiber_proximity::AllowedPair> allowed;
};

/// Reads a scene from a YAML file with the lists `obstacles` and `allowed`, whose fields are those
/// of the messages Obstacle and AllowedPair, but `frame_id` stands for the header; vectors are
/// lists of three numbers, quaternions of four, x y z w. Primitives have the names box, sphere,
/// cylinder or cone as type; meshes may be `{resource: package://..., scale: [1, 1, 1]}`.
/// @throws std::invalid_argument naming file, line, field and value, or the obstacle, and what is
///         allowed
EnvironmentScene read_scene(const std::string& file, const MeshLoader& meshes);

/// The same from a part of a document.
EnvironmentScene read_scene(const YamlField& field, const MeshLoader& meshes);

/// The same from a parameter.
/// @param name of the parameter, for errors
EnvironmentScene read_scene(const std::string& name, const XmlRpc::XmlRpcValue& value,
                            const MeshLoader& meshes);

}  // namespace fiber_proximity_ros
