#include "fiber_proximity/environment/scene/environment_scene.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/environment/world.hpp"
#include "src/environment/obstacle_parts.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

// An obstacle is read in two steps: what is no pose, box and so on is refused with its field, while
// reading; what makes no sense as one is refused with the obstacle, when all of it is read.
using MakePose = std::function<Eigen::Isometry3d()>;
using MakeShape = std::function<Shape()>;

MakePose read_pose(const YamlField& field) {
  field.require_map({"position", "orientation"});
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  field.read("position", position);
  const auto given = field.find("orientation");
  const Eigen::Quaterniond orientation =
      given ? Eigen::Quaterniond(given->numbers(4).data()) : Eigen::Quaterniond::Identity();
  return [position, orientation] { return make_pose(position, orientation); };
}

MakeShape read_primitive(const YamlField& field) {
  static const std::map<std::string, Primitive> types{{"box", Primitive::BOX},
                                                      {"sphere", Primitive::SPHERE},
                                                      {"cylinder", Primitive::CYLINDER},
                                                      {"cone", Primitive::CONE}};
  field.require_map({"type", "dimensions"});
  const auto type = types.find(field.get("type").text());
  if (type == types.end()) {
    field.get("type").refuse("box, sphere, cylinder or cone");
  }
  return [type = type->second, dimensions = field.get("dimensions").numbers()] {
    return make_primitive(type, dimensions);
  };
}

MakeShape read_capsule(const YamlField& field) {
  field.require_map({"radius", "length"});
  const CapsuleShape capsule{field.get("radius").number(), field.get("length").number()};
  return [capsule] { return capsule; };
}

Eigen::Vector4d read_coefficients(const YamlField& field) {
  field.require_map({"coef"});
  return Eigen::Vector4d(field.get("coef").numbers(4).data());
}

MakeShape read_plane(const YamlField& field) {
  return [coefficients = read_coefficients(field)] { return make_plane(coefficients); };
}

MakeShape read_half_space(const YamlField& field) {
  return [coefficients = read_coefficients(field)] { return make_half_space(coefficients); };
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

/// Reads each item of the list of a key with a function; nothing if there is no such key.
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

MakeShape read_mesh(const YamlField& field, const MeshSource& meshes) {
  field.require_map({"resource", "scale", "vertices", "triangles"});
  if (const auto resource = field.find("resource")) {
    field.require_map({"resource", "scale"});
    Eigen::Vector3d scale = Eigen::Vector3d::Ones();
    field.read("scale", scale);
    auto mesh = with_context(resource->place(), [&] { return meshes(resource->text(), scale); });
    return [mesh = std::move(mesh)]() -> Shape { return mesh; };
  }
  field.require_map({"vertices", "triangles"});
  field.get("vertices");
  field.get("triangles");
  return [vertices = read_list(field, "vertices", std::mem_fn(&YamlField::vector)),
          triangles = read_list(field, "triangles", read_triangle)] {
    return std::make_shared<const TriangleMesh>(vertices, triangles);
  };
}

/// @param entry of which errors name the obstacle
/// @param place where it stands, for errors about what it means
EnvironmentObject read_object(const YamlField& entry, const std::string& name,
                              const std::string& place, const MeshSource& meshes) {
  struct List {
    std::string kind;
    std::vector<MakeShape> shapes;
    std::vector<MakePose> poses;
  };
  const auto read_shapes = [&entry](const std::string& kind, const char* shapes, const char* poses,
                                    const auto& read) {
    return List{kind, read_list(entry, shapes, read), read_list(entry, poses, read_pose)};
  };
  const auto pose = entry.find("pose");
  const MakePose object_pose = pose ? read_pose(*pose) : &Eigen::Isometry3d::Identity;
  const auto read_one = [&meshes](const YamlField& field) { return read_mesh(field, meshes); };
  const List lists[] = {
      read_shapes("primitive", "primitives", "primitive_poses", read_primitive),
      read_shapes("capsule", "capsules", "capsule_poses", read_capsule),
      read_shapes("mesh", "meshes", "mesh_poses", read_one),
      read_shapes("plane", "planes", "plane_poses", read_plane),
      read_shapes("half-space", "half_spaces", "half_space_poses", read_half_space)};
  return with_context(place, [&] {
    ObjectChange change;
    change.object.name = name;
    with_context("obstacle " + quote(name), [&] {
      validate_obstacle_name(name);
      change.object.pose = with_context("pose", object_pose);
      const auto call = [](const auto& make) { return make(); };
      for (const List& list : lists) {
        append_shapes(list.kind, list.shapes, list.poses, call, call, change.object.shapes);
      }
    });
    validate(change);
    return change.object;
  });
}

/// @param links where there may be some
SceneObstacle read_link(const YamlField& entry, const LinkSource& links) {
  entry.require_map({"link", "id", "robot_description"});
  const YamlField field = entry.get("link");
  const auto id = entry.find("id");
  const auto description = entry.find("robot_description");
  if (description && description->text().empty()) {
    description->refuse("the name of a parameter");
  }
  SceneObstacle obstacle;
  obstacle.link = field.text();
  obstacle.object.name = id ? id->text() : *obstacle.link;
  obstacle.object.shapes = with_context(field.statement(), [&] {
    return links(*obstacle.link, description ? description->text() : "");
  });
  obstacle.place = entry.named("obstacle " + quote(obstacle.object.name)).place();
  with_context(entry.place(), [&] {
    with_context("obstacle " + quote(obstacle.object.name),
                 [&] { validate_obstacle_name(obstacle.object.name); });
    validate(ObjectChange{ObjectChange::Operation::ADD, obstacle.object});
  });
  return obstacle;
}

/// @param links null where none moves
SceneObstacle read_obstacle(const YamlField& entry, const MeshSource& meshes,
                            const LinkSource* links) {
  if (links != nullptr && entry.is_map() && entry.find("link")) {
    return read_link(entry, *links);
  }
  std::vector<std::string> keys{"id",
                                "frame_id",
                                "pose",
                                "primitives",
                                "primitive_poses",
                                "capsules",
                                "capsule_poses",
                                "meshes",
                                "mesh_poses",
                                "planes",
                                "plane_poses",
                                "half_spaces",
                                "half_space_poses"};
  if (links != nullptr) {
    keys.insert(keys.end(), {"motion", "link"});
  }
  entry.require_map(keys);
  SceneObstacle obstacle;
  const std::string name = entry.get("id").text();
  const YamlField named = entry.named("obstacle " + quote(name));
  if (const auto frame = named.find("frame_id")) {
    obstacle.frame_id = frame->text();
  }
  obstacle.object = read_object(named, name, entry.place(), meshes);
  obstacle.place = named.place();
  obstacle.motion = named.find("motion");
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

EnvironmentScene read_scene(const YamlField& document, const MeshSource& meshes,
                            const LinkSource* links) {
  document.require_map({"obstacles", "allowed"});
  EnvironmentScene scene;
  std::set<std::string> names;
  scene.obstacles = read_list(document, "obstacles", [&](const YamlField& entry) {
    SceneObstacle obstacle = read_obstacle(entry, meshes, links);
    if (!names.insert(obstacle.object.name).second) {
      throw std::invalid_argument(entry.place() + " has the id " + quote(obstacle.object.name) +
                                  " of another obstacle of the scene");
    }
    return obstacle;
  });
  scene.allowed = read_list(document, "allowed", read_pair);
  return scene;
}

}  // namespace

EnvironmentScene read_environment_scene(const YamlField& document, const MeshSource& meshes) {
  return read_scene(document, meshes, nullptr);
}

EnvironmentScene read_moving_environment_scene(const YamlField& document, const MeshSource& meshes,
                                               const LinkSource& links) {
  return read_scene(document, meshes, &links);
}

std::vector<PlacedShape> no_links(const std::string& /*link*/, const std::string& /*description*/) {
  throw std::invalid_argument(
      "links of robots are for cable_sim, which knows their URDF; here it must have shapes of its "
      "own");
}

}  // namespace fiber
