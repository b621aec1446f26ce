#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/yaml/yaml_field.hpp"

namespace fiber {

/// Gives the mesh that a resource names, with each axis scaled.
/// @throws std::invalid_argument naming the resource and what is wrong with it or the scale
using MeshSource = std::function<std::shared_ptr<const TriangleMesh>(const std::string& resource,
                                                                     const Eigen::Vector3d& scale)>;

/// [byte] Larger files are refused unread: twice a binary STL of as many triangles as TriangleMesh
/// takes.
constexpr std::uintmax_t max_mesh_file_size = 100'000'000;

/// Reads a mesh, in any format that assimp knows, in a process of its own: there are files that
/// assimp crashes on, or does not come back from.
/// @param scale of each axis; a mirrored mesh has its triangles turned round, so that they are
///        still counter-clockwise from outside
/// @throws std::invalid_argument saying what is wrong with the file, its size, its content, or the
///         scale
std::shared_ptr<const TriangleMesh> read_mesh_file(const std::filesystem::path& file,
                                                   const Eigen::Vector3d& scale);

/// Meshes of files: a resource is file:///PATH, or a path, which begins in a folder if it does not
/// begin with a slash.
MeshSource mesh_files(const std::filesystem::path& folder);

/// Gives the collision shapes of a link of a robot, in the link's frame.
/// @param description where the robot's URDF is, as the document calls it; empty: where it is by
///        default
/// @throws std::invalid_argument saying what is wrong with them
using LinkSource = std::function<std::vector<PlacedShape>(const std::string& link,
                                                          const std::string& description)>;

/// For whoever knows no robots.
/// @throws std::invalid_argument always
std::vector<PlacedShape> no_links(const std::string& link, const std::string& description);

/// An object around the fibres, and the frame that its pose is in.
struct SceneObstacle {
  std::string frame_id;  ///< empty: that of the fibres
  EnvironmentObject object;
  std::string place;                ///< in the document, for errors
  std::optional<YamlField> motion;  ///< how it moves, where that may be told
  std::optional<std::string> link;  ///< of a robot, that it is
};

/// Obstacles around the fibres from the start.
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

/// Reads obstacles that may move, too: those with the key `motion`, which the caller reads, and
/// links of robots, `{link: NAME, id: NAME, robot_description: NAME}`, whose ids are by default
/// those of the links.
/// @throws std::invalid_argument alike
EnvironmentScene read_moving_environment_scene(const YamlField& document, const MeshSource& meshes,
                                               const LinkSource& links);

}  // namespace fiber
