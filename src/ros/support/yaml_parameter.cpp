#include "src/ros/support/yaml_parameter.hpp"

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

}  // namespace

fiber::YamlField to_yaml(const std::string& name, const XmlRpcValue& value) {
  return {to_yaml(value), "parameter " + name};
}

}  // namespace fiber_proximity_ros
