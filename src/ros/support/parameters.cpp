#include "src/ros/support/parameters.hpp"

#include <ros/console.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <sstream>
#include <stdexcept>

#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using XmlRpc::XmlRpcValue;

/// Counts the letters that must be changed, added or left out to make one name of the other.
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

/// Suggests the nearest known name if it is near enough to have been meant.
std::string suggested_parameter(const std::string& name, const std::vector<Parameter>& known) {
  const std::string* nearest = nullptr;
  std::size_t least = std::max<std::size_t>(1, name.size() / 3);
  for (const Parameter& candidate : known) {
    const std::size_t distance = edit_distance(name, candidate.name);
    if (distance <= least && (nearest == nullptr || distance < least)) {
      nearest = &candidate.name;
      least = distance;
    }
  }
  return nearest == nullptr ? "" : "; is " + *nearest + " meant?";
}

bool is_allowed(const Parameter& parameter, const XmlRpcValue& value) {
  const auto is_in_range = [&](double number) {
    return number >= parameter.min && number <= parameter.max;
  };
  const std::vector<std::string>& values = parameter.values;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return parameter.type == "bool";
    case XmlRpcValue::TypeInt:
      return (parameter.type == "int" || parameter.type == "double") &&
             is_in_range(static_cast<const int&>(value));
    case XmlRpcValue::TypeDouble:
      return parameter.type == "double" && is_in_range(static_cast<const double&>(value));
    case XmlRpcValue::TypeString:
      return (parameter.type == "str" && values.empty()) ||
             std::find(values.begin(), values.end(), static_cast<const std::string&>(value)) !=
                 values.end();
    default:
      return false;
  }
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
  if (value.getType() == XmlRpcValue::TypeBoolean) {
    return static_cast<const bool&>(value) ? "true" : "false";  // not as a number
  }
  std::ostringstream stream;
  stream << value;
  return fiber::shortened(stream.str());
}

void refuse_value(const std::string& what, const XmlRpcValue& value, const std::string& must_be) {
  throw std::invalid_argument(what + " is " + text_of(value) + ", it must be " + must_be);
}

XmlRpcValue checked(const Parameter& parameter, const XmlRpcValue& value, const std::string& what) {
  if (!is_allowed(parameter, value)) {
    refuse_value(what, value, parameter.must_be);
  }
  const bool is_whole = parameter.type == "double" && value.getType() == XmlRpcValue::TypeInt;
  return is_whole ? XmlRpcValue(static_cast<double>(static_cast<const int&>(value))) : value;
}

const Parameter* NodeInterface::find(const std::string& name) const {
  const auto found = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const Parameter& known) { return known.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

const Parameter& NodeInterface::at(const std::string& name) const {
  const Parameter* const parameter = find(name);
  if (parameter == nullptr) {
    throw std::out_of_range("parameter " + name + " is not in cfg/interface.yaml");
  }
  return *parameter;
}

void Parameters::require_allowed(const std::string& name, const XmlRpcValue& value) const {
  checked(interface_.at(name), value, title(name));
}

std::string Parameters::title(const std::string& name) const {
  return "parameter " + node_.resolveName(name);
}

void Parameters::refuse(const std::string& name) const {
  refuse(name, interface_.at(name).must_be);
}

void Parameters::refuse(const std::string& name, const std::string& must_be) const {
  XmlRpcValue value;
  node_.getParam(name, value);
  refuse_value(title(name), value, must_be);
}

XmlRpcValue Parameters::read_checked(const std::string& name) const {
  const Parameter& parameter = interface_.at(name);
  XmlRpcValue value;
  if (!node_.getParam(name, value)) {
    return parameter.value;
  }
  return checked(parameter, value, title(name));
}

void Parameters::warn_of_unknown() const {
  std::vector<std::string> names;
  node_.getParamNames(names);
  const std::string prefix = node_.getNamespace() + "/";
  std::set<std::string> unknown;
  for (const std::string& name : names) {
    if (name.rfind(prefix, 0) != 0) {
      continue;
    }
    const std::string own =
        name.substr(prefix.size(), name.find('/', prefix.size()) - prefix.size());
    if (interface_.find(own) == nullptr) {
      unknown.insert(own);
    }
  }
  for (const std::string& name : unknown) {
    ROS_WARN_STREAM("parameter " << prefix << name << " is unknown and not used"
                                 << suggested_parameter(name, interface_.parameters));
  }
}

fiber::YamlField to_yaml(const std::string& name, const XmlRpcValue& value) {
  return {to_yaml(value), "parameter " + name};
}

}  // namespace fiber_proximity_ros
