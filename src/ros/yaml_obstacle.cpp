#include "fiber_proximity/ros/yaml_obstacle.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::Obstacle;
using shape_msgs::SolidPrimitive;

geometry_msgs::Pose read_pose(const YamlField& field) {
  field.require_map({"position", "orientation"});
  geometry_msgs::Pose pose;
  pose.orientation.w = 1.0;
  if (const auto position = field.find("position")) {
    pose.position = to_message(position->vector());
  }
  if (const auto orientation = field.find("orientation")) {
    const std::vector<double> xyzw = orientation->numbers(4);
    pose.orientation.x = xyzw[0];
    pose.orientation.y = xyzw[1];
    pose.orientation.z = xyzw[2];
    pose.orientation.w = xyzw[3];
  }
  return pose;
}

SolidPrimitive read_primitive(const YamlField& field) {
  static const std::map<std::string, std::uint8_t> types{{"box", SolidPrimitive::BOX},
                                                         {"sphere", SolidPrimitive::SPHERE},
                                                         {"cylinder", SolidPrimitive::CYLINDER},
                                                         {"cone", SolidPrimitive::CONE}};
  field.require_map({"type", "dimensions"});
  const auto type = types.find(field.get("type").text());
  if (type == types.end()) {
    field.get("type").refuse("box, sphere, cylinder or cone");
  }
  SolidPrimitive primitive;
  primitive.type = type->second;
  primitive.dimensions = field.get("dimensions").numbers();
  return primitive;
}

fiber_proximity::Capsule read_capsule(const YamlField& field) {
  field.require_map({"radius", "length"});
  fiber_proximity::Capsule capsule;
  capsule.radius = field.get("radius").number();
  capsule.length = field.get("length").number();
  return capsule;
}

shape_msgs::Plane read_plane(const YamlField& field) {
  field.require_map({"coef"});
  const std::vector<double> coefficients = field.get("coef").numbers(4);
  shape_msgs::Plane plane;
  std::copy(coefficients.begin(), coefficients.end(), plane.coef.begin());
  return plane;
}

shape_msgs::MeshTriangle read_triangle(const YamlField& field) {
  const std::vector<YamlField> indices = field.items();
  shape_msgs::MeshTriangle triangle;
  if (indices.size() != triangle.vertex_indices.size()) {
    field.refuse("a list of 3 indices of vertices");
  }
  for (std::size_t i = 0; i < indices.size(); ++i) {
    triangle.vertex_indices[i] = static_cast<std::uint32_t>(
        indices[i].integer(0, std::numeric_limits<std::uint32_t>::max()));
  }
  return triangle;
}

shape_msgs::Mesh load_mesh(const YamlField& resource, const std::optional<YamlField>& scale,
                           const MeshLoader& meshes) {
  const Eigen::Vector3d factors = scale ? scale->vector() : Eigen::Vector3d::Ones();
  try {
    return meshes.load(resource.text(), factors);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(resource.place() + ": " + error.what());
  }
}

shape_msgs::Mesh read_mesh(const YamlField& field, const MeshLoader& meshes) {
  field.require_map({"resource", "scale", "vertices", "triangles"});
  if (const auto resource = field.find("resource")) {
    field.require_map({"resource", "scale"});
    return load_mesh(*resource, field.find("scale"), meshes);
  }
  field.require_map({"vertices", "triangles"});
  shape_msgs::Mesh mesh;
  for (const YamlField& vertex : field.get("vertices").items()) {
    mesh.vertices.push_back(to_message(vertex.vector()));
  }
  for (const YamlField& triangle : field.get("triangles").items()) {
    mesh.triangles.push_back(read_triangle(triangle));
  }
  return mesh;
}

/// Reads the list of a key, if there is one.
template <class Value, class Read>
void read_list(const YamlField& entry, const std::string& key, const Read& read,
               std::vector<Value>& values) {
  if (const auto list = entry.find(key)) {
    for (const YamlField& item : list->items()) {
      values.push_back(read(item));
    }
  }
}

void read_shapes(const YamlField& entry, const MeshLoader& meshes, Obstacle& obstacle) {
  read_list(entry, "primitives", read_primitive, obstacle.primitives);
  read_list(entry, "primitive_poses", read_pose, obstacle.primitive_poses);
  read_list(entry, "capsules", read_capsule, obstacle.capsules);
  read_list(entry, "capsule_poses", read_pose, obstacle.capsule_poses);
  read_list(
      entry, "meshes", [&meshes](const YamlField& field) { return read_mesh(field, meshes); },
      obstacle.meshes);
  read_list(entry, "mesh_poses", read_pose, obstacle.mesh_poses);
  read_list(entry, "planes", read_plane, obstacle.planes);
  read_list(entry, "plane_poses", read_pose, obstacle.plane_poses);
  read_list(entry, "half_spaces", read_plane, obstacle.half_spaces);
  read_list(entry, "half_space_poses", read_pose, obstacle.half_space_poses);
}

}  // namespace

Obstacle read_obstacle(const YamlField& entry, const MeshLoader& meshes) {
  entry.require_map({"id", "frame_id", "pose", "primitives", "primitive_poses", "capsules",
                     "capsule_poses", "meshes", "mesh_poses", "planes", "plane_poses",
                     "half_spaces", "half_space_poses"});
  Obstacle obstacle;
  obstacle.operation = Obstacle::ADD;
  obstacle.id = entry.get("id").text();
  const YamlField named = entry.named("obstacle " + fiber::quote(obstacle.id));
  if (const auto frame = named.find("frame_id")) {
    obstacle.header.frame_id = frame->text();
  }
  if (const auto pose = named.find("pose")) {
    obstacle.pose = read_pose(*pose);
  }
  read_shapes(named, meshes, obstacle);
  return obstacle;
}

fiber_proximity::AllowedPair read_allowed_pair(const YamlField& entry) {
  entry.require_map({"object", "fiber", "segments"});
  fiber_proximity::AllowedPair pair;
  if (const auto object = entry.find("object")) {
    pair.object = object->text();
  }
  if (const auto fiber = entry.find("fiber")) {
    pair.fiber = fiber->text();
  }
  const auto read_index = [](const YamlField& field) {
    return static_cast<std::int32_t>(field.integer(std::numeric_limits<std::int32_t>::min(),
                                                   std::numeric_limits<std::int32_t>::max()));
  };
  read_list(entry, "segments", read_index, pair.segments);
  return pair;
}

}  // namespace fiber_proximity_ros
