#include "src/ros/support/parameters.hpp"

#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <stdexcept>

#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using XmlRpc::XmlRpcValue;

/// How many letters must be changed, added or left out to make one name of the other.
std::size_t edit_distance(const std::string& from, const std::string& to) {
  std::vector<std::size_t> row(to.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < from.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < to.size(); ++j) {
      const std::size_t changed = diagonal + (from[i] == to[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({changed, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

/// The known name that is nearest, if it is near enough to have been meant.
std::string suggested_parameter(const std::string& name, const std::vector<std::string>& known) {
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3);
  for (const std::string& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate);
    if (distance <= least && (nearest == nullptr || distance < least)) {
      nearest = &candidate;
      least = distance;
    }
  }
  return nearest == nullptr ? "" : "; is " + *nearest + " meant?";
}

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

std::string text_of(const XmlRpcValue& value) {
  std::ostringstream stream;
  stream << value;
  return fiber::shortened(stream.str());
}

void refuse_parameter(const ros::NodeHandle& node, const std::string& name,
                      const std::string& allowed) {
  XmlRpcValue value;
  node.getParam(name, value);
  throw std::invalid_argument("parameter " + node.resolveName(name) + " is " + text_of(value) +
                              ", it must be " + allowed);
}

void read_parameter(const ros::NodeHandle& node, const std::string& name, const Limits& limits,
                    double& value) {
  const std::string allowed = allowed_range("a number", limits.least, limits.most);
  read_parameter(node, name, allowed, value);
  if (!(value >= limits.least && value <= limits.most && std::isfinite(value))) {
    refuse_parameter(node, name, allowed);
  }
}

void read_parameter(const ros::NodeHandle& node, const std::string& name, int least, int& value) {
  XmlRpcValue number;
  if (!node.getParam(name, number)) {
    return;
  }
  if (number.getType() != XmlRpcValue::TypeInt || static_cast<const int&>(number) < least) {
    refuse_parameter(node, name,
                     allowed_range("a whole number", least, std::numeric_limits<int>::max()));
  }
  value = static_cast<const int&>(number);
}

void read_parameter(const ros::NodeHandle& node, const std::string& name, std::uint32_t& value) {
  auto number = static_cast<int>(value);
  read_parameter(node, name, 0, number);
  value = static_cast<std::uint32_t>(number);
}

void warn_of_unknown_parameters(const ros::NodeHandle& private_node,
                                const std::vector<std::string>& known) {
  std::vector<std::string> names;
  private_node.getParamNames(names);
  const std::string prefix = private_node.getNamespace() + "/";
  std::set<std::string> unknown;
  for (const std::string& name : names) {
    if (name.rfind(prefix, 0) != 0) {
      continue;
    }
    const std::string own =
        name.substr(prefix.size(), name.find('/', prefix.size()) - prefix.size());
    if (std::find(known.begin(), known.end(), own) == known.end()) {
      unknown.insert(own);
    }
  }
  for (const std::string& name : unknown) {
    ROS_WARN_STREAM("parameter " << prefix << name << " is unknown and not used"
                                 << suggested_parameter(name, known));
  }
}

fiber::YamlField to_yaml(const std::string& name, const XmlRpcValue& value) {
  return {to_yaml(value), "parameter " + name};
}

}  // namespace fiber_proximity_ros
