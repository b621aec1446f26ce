#include "fiber_proximity/ros/environment_scene.hpp"

#include <set>
#include <stdexcept>

#include "fiber_proximity/ros/allowed_contacts.hpp"
#include "fiber_proximity/ros/load_yaml.hpp"
#include "fiber_proximity/ros/naming.hpp"
#include "fiber_proximity/ros/obstacle_change.hpp"
#include "fiber_proximity/ros/yaml_obstacle.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using XmlRpc::XmlRpcValue;

YAML::Node to_yaml(const XmlRpcValue& value) {
  YAML::Node node;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<const bool&>(value));
    case XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<const int&>(value));
    case XmlRpcValue::TypeDouble:
      return YAML::Node(static_cast<const double&>(value));
    case XmlRpcValue::TypeString:
      return YAML::Node(static_cast<const std::string&>(value));
    case XmlRpcValue::TypeArray:
      node = YAML::Node(YAML::NodeType::Sequence);
      // NOLINTNEXTLINE(modernize-loop-convert): its iterators are those of maps
      for (int i = 0; i < value.size(); ++i) {
        node.push_back(to_yaml(value[i]));
      }
      return node;
    case XmlRpcValue::TypeStruct:
      node = YAML::Node(YAML::NodeType::Map);
      for (const auto& [key, child] : value) {
        node[key] = to_yaml(child);
      }
      return node;
    default:
      return node;
  }
}

void read_obstacles(const YamlField& list, const MeshLoader& meshes,
                    std::vector<FramedChange>& changes) {
  std::set<std::string> ids;
  for (const YamlField& entry : list.items()) {
    const fiber_proximity::Obstacle obstacle = read_obstacle(entry, meshes);
    if (!ids.insert(obstacle.id).second) {
      throw std::invalid_argument(entry.place() + " has the id " + fiber::quote(obstacle.id) +
                                  " of another obstacle of the scene");
    }
    naming(entry.place(), [&] {
      changes.push_back(to_changes({obstacle}).front());
      fiber::World().apply({changes.back().change});  // what is refused is refused here
    });
  }
}

void read_allowed(const YamlField& list, std::vector<fiber_proximity::AllowedPair>& pairs) {
  for (const YamlField& entry : list.items()) {
    pairs.push_back(read_allowed_pair(entry));
    naming(entry.place(), [&pairs] { validate(pairs.back()); });
  }
}

}  // namespace

EnvironmentScene read_scene(const YamlField& field, const MeshLoader& meshes) {
  field.require_map({"obstacles", "allowed"});
  EnvironmentScene scene;
  if (const auto obstacles = field.find("obstacles")) {
    read_obstacles(*obstacles, meshes, scene.obstacles);
  }
  if (const auto allowed = field.find("allowed")) {
    read_allowed(*allowed, scene.allowed);
  }
  return scene;
}

EnvironmentScene read_scene(const std::string& file, const MeshLoader& meshes) {
  return read_scene(load_yaml(file), meshes);
}

EnvironmentScene read_scene(const std::string& name, const XmlRpcValue& value,
                            const MeshLoader& meshes) {
  return read_scene(YamlField(to_yaml(value), "parameter " + name), meshes);
}

}  // namespace fiber_proximity_ros
