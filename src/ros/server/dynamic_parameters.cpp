#include "src/ros/server/dynamic_parameters.hpp"

#include <algorithm>
#include <regex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "src/ros/server/query_settings.hpp"
#include "src/ros/support/parameters.hpp"
#include "src/text/join.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::ProximityConfig;
using XmlRpc::XmlRpcValue;
using Description = ProximityConfig::AbstractParamDescription;

/// The parameters whose values are names of kernels.
constexpr std::pair<const char*, std::string ProximityConfig::*> kernel_parameters[] = {
    {"kernel", &ProximityConfig::kernel}, {"accuracy", &ProximityConfig::accuracy}};

template <class Value>
Value config_value(const Description& parameter, const ProximityConfig& config) {
  boost::any value;
  parameter.getValue(config, value);
  return boost::any_cast<Value>(value);
}

/// The value of a configuration as the parameter server has it.
XmlRpcValue to_xml_rpc(const Description& parameter, const ProximityConfig& config) {
  if (parameter.type == "bool") {
    return XmlRpcValue(config_value<bool>(parameter, config));
  }
  if (parameter.type == "int") {
    return XmlRpcValue(config_value<int>(parameter, config));
  }
  if (parameter.type == "double") {
    return XmlRpcValue(config_value<double>(parameter, config));
  }
  return XmlRpcValue(config_value<std::string>(parameter, config));
}

/// The values of an enumeration, which are in the text that tells clients how to edit it.
std::vector<std::string> values_of_enumeration(const Description& parameter) {
  static const std::regex value("'value': '([^']*)'");
  std::vector<std::string> values;
  const std::string& text = parameter.edit_method;
  for (std::sregex_iterator i(text.begin(), text.end(), value); i != std::sregex_iterator(); ++i) {
    values.push_back((*i)[1]);
  }
  return values;
}

template <class Number>
std::string allowed_number(const std::string& kind, const Description& parameter) {
  return allowed_range(kind, config_value<Number>(parameter, ProximityConfig::__getMin__()),
                       config_value<Number>(parameter, ProximityConfig::__getMax__()));
}

std::string what_is_allowed(const Description& parameter) {
  if (parameter.type == "bool") {
    return "true or false";
  }
  if (parameter.type == "int") {
    return allowed_number<int>("a whole number", parameter);
  }
  if (parameter.type == "double") {
    return allowed_number<double>("a number", parameter);
  }
  return "one of " + fiber::join(values_of_enumeration(parameter));
}

template <class Number>
bool is_in_range(const Description& parameter, Number number) {
  return number >= config_value<Number>(parameter, ProximityConfig::__getMin__()) &&
         number <= config_value<Number>(parameter, ProximityConfig::__getMax__());
}

bool is_allowed(const Description& parameter, const XmlRpcValue& value) {
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return parameter.type == "bool";
    case XmlRpcValue::TypeInt: {
      const int number = static_cast<const int&>(value);
      return parameter.type == "double" ? is_in_range<double>(parameter, number)
                                        : parameter.type == "int" && is_in_range(parameter, number);
    }
    case XmlRpcValue::TypeDouble:
      return parameter.type == "double" &&
             is_in_range(parameter, static_cast<const double&>(value));
    case XmlRpcValue::TypeString: {
      const std::vector<std::string> values = values_of_enumeration(parameter);
      return parameter.type == "str" &&
             std::find(values.begin(), values.end(), static_cast<const std::string&>(value)) !=
                 values.end();
    }
    default:
      return false;
  }
}

void require_allowed(const ros::NodeHandle& node, const Description& parameter,
                     const XmlRpcValue& value) {
  if (!is_allowed(parameter, value)) {
    throw std::invalid_argument("parameter " + node.resolveName(parameter.name) + " is " +
                                text_of(value) + ", it must be " + what_is_allowed(parameter));
  }
}

/// @returns the names that are no parameters of this type
template <class Entries>
std::string not_of_type(const std::string& type, const Entries& entries) {
  for (const auto& entry : entries) {
    const auto& parameters = ProximityConfig::__getParamDescriptions__();
    const auto found =
        std::find_if(parameters.begin(), parameters.end(),
                     [&entry](const auto& parameter) { return parameter->name == entry.name; });
    if (found == parameters.end()) {
      return "there is no parameter " + entry.name;
    }
    if ((*found)->type != type) {
      return "parameter " + entry.name + " is a value of type " + type + ", it must be " +
             what_is_allowed(**found);
    }
  }
  return "";
}

}  // namespace

void replace_old_names(const ros::NodeHandle& private_node, ProximityConfig& config) {
  for (const auto& [name, member] : kernel_parameters) {
    std::string& value = config.*member;
    value = current_kernel_name("parameter " + private_node.resolveName(name), value);
  }
}

ProximityConfig read_dynamic_parameters(const ros::NodeHandle& private_node) {
  for (const auto& [name, member] : kernel_parameters) {
    std::string value;
    if (!private_node.getParam(name, value)) {
      continue;
    }
    const std::string current =
        current_kernel_name("parameter " + private_node.resolveName(name), value);
    if (current != value) {
      private_node.setParam(name, current);  // where dynamic_reconfigure will read it, too
    }
  }
  for (const auto& parameter : ProximityConfig::__getParamDescriptions__()) {
    XmlRpcValue value;
    if (private_node.getParam(parameter->name, value)) {
      require_allowed(private_node, *parameter, value);
    }
  }
  ProximityConfig config = ProximityConfig::__getDefault__();
  config.__fromServer__(private_node);
  check(private_node, config);
  return config;
}

void check(const ros::NodeHandle& private_node, const ProximityConfig& config) {
  for (const auto& parameter : ProximityConfig::__getParamDescriptions__()) {
    require_allowed(private_node, *parameter, to_xml_rpc(*parameter, config));
  }
  try {
    to_query_options(config);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("parameter " + private_node.getNamespace() + "/" + error.what());
  }
}

// NOLINTNEXTLINE(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp)
bool AskedConfig::__fromMessage__(dynamic_reconfigure::Config& message) {
  for (const std::string& problem :
       {not_of_type("bool", message.bools), not_of_type("int", message.ints),
        not_of_type("double", message.doubles), not_of_type("str", message.strs)}) {
    if (!problem.empty()) {
      problem_ = problem;
      return false;
    }
  }
  problem_.clear();
  return ProximityConfig::__fromMessage__(message);
}

}  // namespace fiber_proximity_ros
