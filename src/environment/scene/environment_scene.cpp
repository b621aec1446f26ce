#include "fiber_proximity/environment/scene/environment_scene.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>

#include "fiber_proximity/environment/obstacle_parts.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/environment/world.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber {
namespace {

// What the document says of an obstacle, before it is known to make sense.

struct PoseEntry {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
};

struct PrimitiveEntry {
  Primitive type = Primitive::BOX;
  std::vector<double> dimensions;
};

struct MeshEntry {
  std::shared_ptr<const TriangleMesh> loaded;  // null: the following
  std::vector<Eigen::Vector3d> vertices;
  std::vector<TriangleMesh::Triangle> triangles;
};

PoseEntry read_pose(const YamlField& field) {
  field.require_map({"position", "orientation"});
  PoseEntry pose;
  field.read("position", pose.position);
  if (const auto orientation = field.find("orientation")) {
    pose.orientation = Eigen::Quaterniond(orientation->numbers(4).data());
  }
  return pose;
}

PrimitiveEntry read_primitive(const YamlField& field) {
  static const std::map<std::string, Primitive> types{{"box", Primitive::BOX},
                                                      {"sphere", Primitive::SPHERE},
                                                      {"cylinder", Primitive::CYLINDER},
                                                      {"cone", Primitive::CONE}};
  field.require_map({"type", "dimensions"});
  const auto type = types.find(field.get("type").text());
  if (type == types.end()) {
    field.get("type").refuse("box, sphere, cylinder or cone");
  }
  return {type->second, field.get("dimensions").numbers()};
}

CapsuleShape read_capsule(const YamlField& field) {
  field.require_map({"radius", "length"});
  return {field.get("radius").number(), field.get("length").number()};
}

Eigen::Vector4d read_plane(const YamlField& field) {
  field.require_map({"coef"});
  return Eigen::Vector4d(field.get("coef").numbers(4).data());
}

TriangleMesh::Triangle read_triangle(const YamlField& field) {
  const std::vector<YamlField> indices = field.items();
  TriangleMesh::Triangle triangle{};
  if (indices.size() != triangle.size()) {
    field.refuse("a list of 3 indices of vertices");
  }
  std::transform(indices.begin(), indices.end(), triangle.begin(), [](const YamlField& index) {
    return static_cast<std::uint32_t>(index.integer(0, std::numeric_limits<std::uint32_t>::max()));
  });
  return triangle;
}

MeshEntry read_mesh(const YamlField& field, const MeshSource& meshes) {
  field.require_map({"resource", "scale", "vertices", "triangles"});
  MeshEntry mesh;
  if (const auto resource = field.find("resource")) {
    field.require_map({"resource", "scale"});
    Eigen::Vector3d scale = Eigen::Vector3d::Ones();
    field.read("scale", scale);
    mesh.loaded = with_context(resource->place(), [&] { return meshes(resource->text(), scale); });
    return mesh;
  }
  field.require_map({"vertices", "triangles"});
  for (const YamlField& vertex : field.get("vertices").items()) {
    mesh.vertices.push_back(vertex.vector());
  }
  for (const YamlField& triangle : field.get("triangles").items()) {
    mesh.triangles.push_back(read_triangle(triangle));
  }
  return mesh;
}

/// What a function reads of each item of the list of a key; nothing if there is no such key.
template <class Read>
auto read_list(const YamlField& entry, const std::string& key, const Read& read) {
  std::vector<decltype(read(entry))> values;
  if (const auto list = entry.find(key)) {
    for (const YamlField& item : list->items()) {
      values.push_back(read(item));
    }
  }
  return values;
}

Shape shape_of(const PrimitiveEntry& primitive) {
  return make_primitive(primitive.type, primitive.dimensions);
}

Shape shape_of(const MeshEntry& mesh) {
  return mesh.loaded != nullptr
             ? mesh.loaded
             : std::make_shared<const TriangleMesh>(mesh.vertices, mesh.triangles);
}

/// @param entry of which errors name the obstacle
/// @param place where it stands, for errors about what it means
EnvironmentObject read_object(const YamlField& entry, const std::string& name,
                              const std::string& place, const MeshSource& meshes) {
  const auto pose = entry.find("pose");
  const PoseEntry object_pose = pose ? read_pose(*pose) : PoseEntry();
  const auto read_poses = [&entry](const char* key) { return read_list(entry, key, read_pose); };
  const auto primitives = read_list(entry, "primitives", read_primitive);
  const auto primitive_poses = read_poses("primitive_poses");
  const auto capsules = read_list(entry, "capsules", read_capsule);
  const auto capsule_poses = read_poses("capsule_poses");
  const auto mesh_entries = read_list(
      entry, "meshes", [&meshes](const YamlField& mesh) { return read_mesh(mesh, meshes); });
  const auto mesh_poses = read_poses("mesh_poses");
  const auto planes = read_list(entry, "planes", read_plane);
  const auto plane_poses = read_poses("plane_poses");
  const auto half_spaces = read_list(entry, "half_spaces", read_plane);
  const auto half_space_poses = read_poses("half_space_poses");
  return with_context(place, [&] {
    ObjectChange change;
    EnvironmentObject& object = change.object;
    with_context("obstacle " + quote(name), [&] {
      validate_obstacle_name(name);
      object.name = name;
      const auto pose_of = [](const PoseEntry& given) {
        return make_pose(given.position, given.orientation);
      };
      object.pose = with_context("pose", [&] { return pose_of(object_pose); });
      const auto make = [](const auto& given) { return shape_of(given); };
      const auto keep = [](const CapsuleShape& capsule) { return capsule; };
      append_shapes("primitive", primitives, primitive_poses, make, pose_of, object.shapes);
      append_shapes("capsule", capsules, capsule_poses, keep, pose_of, object.shapes);
      append_shapes("mesh", mesh_entries, mesh_poses, make, pose_of, object.shapes);
      append_shapes("plane", planes, plane_poses, make_plane, pose_of, object.shapes);
      append_shapes("half-space", half_spaces, half_space_poses, make_half_space, pose_of,
                    object.shapes);
    });
    validate(change);
    return object;
  });
}

SceneObstacle read_obstacle(const YamlField& entry, const MeshSource& meshes) {
  entry.require_map({"id", "frame_id", "pose", "primitives", "primitive_poses", "capsules",
                     "capsule_poses", "meshes", "mesh_poses", "planes", "plane_poses",
                     "half_spaces", "half_space_poses"});
  SceneObstacle obstacle;
  const std::string name = entry.get("id").text();
  const YamlField named = entry.named("obstacle " + quote(name));
  if (const auto frame = named.find("frame_id")) {
    obstacle.frame_id = frame->text();
  }
  obstacle.object = read_object(named, name, entry.place(), meshes);
  return obstacle;
}

NamedPair read_pair(const YamlField& entry) {
  entry.require_map({"object", "fiber", "segments"});
  NamedPair pair;
  if (const auto object = entry.find("object")) {
    pair.object = object->text();
  }
  if (const auto fiber = entry.find("fiber")) {
    pair.fiber = fiber->text();
  }
  pair.segments = read_list(entry, "segments", [](const YamlField& field) {
    return static_cast<std::int32_t>(field.integer(std::numeric_limits<std::int32_t>::min(),
                                                   std::numeric_limits<std::int32_t>::max()));
  });
  with_context(entry.place(), [&pair] { validate(pair); });
  return pair;
}

}  // namespace

EnvironmentScene read_environment_scene(const YamlField& document, const MeshSource& meshes) {
  document.require_map({"obstacles", "allowed"});
  EnvironmentScene scene;
  std::set<std::string> names;
  scene.obstacles = read_list(document, "obstacles", [&](const YamlField& entry) {
    SceneObstacle obstacle = read_obstacle(entry, meshes);
    if (!names.insert(obstacle.object.name).second) {
      throw std::invalid_argument(entry.place() + " has the id " + quote(obstacle.object.name) +
                                  " of another obstacle of the scene");
    }
    return obstacle;
  });
  scene.allowed = read_list(document, "allowed", read_pair);
  return scene;
}

}  // namespace fiber
