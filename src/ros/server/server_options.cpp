#include "src/ros/server/server_options.hpp"

#include <ros/console.h>

#include <algorithm>
#include <regex>
#include <stdexcept>
#include <utility>

#include "src/ros/environment/environment_options.hpp"
#include "src/ros/server/query_options.hpp"
#include "src/ros/support/parameters.hpp"
#include "src/text/join.hpp"
#include "src/text/with_context.hpp"

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

/// @throws std::invalid_argument if a fibre would have the name of another input's
void require_new_name(const InputOptions& input, const std::vector<InputOptions>& others) {
  for (const InputOptions& other : others) {
    if (other.name == input.name) {
      throw std::invalid_argument("key 'name' is " + input.name +
                                  " (without it, the topic), as of " + other.where +
                                  ", it must be another one");
    }
  }
}

/// @throws std::invalid_argument for a topic that has another type here, or would feed back
void require_foreign_topic(const InputOptions& input, const ros::NodeHandle& node,
                           const ros::NodeHandle& private_node) {
  for (const char* const own : {"obstacles", "cloud", "contacts", "environment_contacts",
                                "crossings", "comparison", "fibers", "markers", "statistics"}) {
    if (node.resolveName(input.topic) == private_node.resolveName(own)) {
      throw std::invalid_argument("key 'topic' is " + input.topic +
                                  ", it must be none of the node's own topics");
    }
  }
}

std::vector<InputOptions> read_inputs(const ros::NodeHandle& public_node,
                                      const ros::NodeHandle& node, double radius) {
  InputOptions default_input;
  default_input.topic = "fibers";
  default_input.name = default_input.topic;
  default_input.radius = radius;
  default_input.where = "the default of parameter " + node.resolveName("inputs");
  XmlRpcValue list;
  if (!node.getParam("inputs", list)) {
    return {default_input};
  }
  if (list.getType() != XmlRpcValue::TypeArray) {
    refuse_parameter(node, "inputs", "a list of maps with the key 'topic' at least");
  }
  if (list.size() == 0) {
    ROS_WARN_STREAM("parameter " << node.resolveName("inputs")
                                 << " is an empty list: no fibres will arrive");
  }
  std::vector<InputOptions> inputs;
  for (int i = 0; i < list.size(); ++i) {
    const std::string where =
        "parameter " + node.resolveName("inputs") + ", entry " + std::to_string(i);
    try {
      InputOptions input = read_input_options(list[i], radius);
      input.where = where;
      require_foreign_topic(input, public_node, node);
      require_new_name(input, inputs);
      inputs.push_back(input);
    } catch (const std::invalid_argument& error) {
      ROS_ERROR_STREAM(where << " is left out: " << error.what());
    }
  }
  return inputs;
}

/// What an engine refuses is the value of a parameter.
void check_engine(const ros::NodeHandle& private_node, const ServerOptions& options) {
  const std::string prefix = "parameter " + private_node.getNamespace() + "/";
  fiber::with_context(prefix + "engine", [&] { fiber::make_engine(options.engine); });
  try {
    fiber::make_engine(options.engine, options.engine_options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(prefix + error.what());  // which begins with the name
  }
}

}  // namespace

std::vector<std::string> known_parameters() {
  std::vector<std::string> known{
      "engine",    "threads",         "skin",        "fixed_frame",     "inputs",
      "radius",    "input_timeout",   "marker_rate", "tf_timeout",      "diagnostic_period",
      "crossings", "max_stamp_ahead", "synchronize", "synchronize_slop"};
  known.insert(known.end(), environment_parameters().begin(), environment_parameters().end());
  for (const auto& parameter : ProximityConfig::__getParamDescriptions__()) {
    known.push_back(parameter->name);
  }
  return known;
}

ServerOptions read_server_options(const ros::NodeHandle& node,
                                  const ros::NodeHandle& private_node) {
  constexpr double shortest_timeout = 1e-3;
  constexpr double slowest_rate = 1e-3;
  ServerOptions options;
  double radius = InputOptions().radius;
  read_parameter(private_node, "engine", "a string", options.engine);
  read_parameter(private_node, "threads", options.engine_options.threads);
  read_parameter(private_node, "skin", 0.0, options.engine_options.skin);
  read_parameter(private_node, "fixed_frame", "a string", options.fixed_frame);
  read_parameter(private_node, "radius", Limits{0.0, fiber::FiberAssembly::max_coordinate}, radius);
  read_parameter(private_node, "tf_timeout", 0.0, options.timing.tf_timeout);
  read_parameter(private_node, "input_timeout", shortest_timeout, options.timing.input_timeout);
  read_parameter(private_node, "max_stamp_ahead", 0.0, options.timing.max_stamp_ahead);
  read_parameter(private_node, "synchronize", "true or false", options.timing.synchronize);
  read_parameter(private_node, "synchronize_slop", 0.0, options.timing.synchronize_slop);
  read_parameter(private_node, "marker_rate", slowest_rate, options.marker_rate);
  // Read by diagnostic_updater, which keeps silent about what is none.
  double diagnostic_period = 1.0;
  read_parameter(private_node, "diagnostic_period", shortest_timeout, diagnostic_period);
  check_engine(private_node, options);
  options.config = read_dynamic_parameters(private_node);
  options.inputs = read_inputs(node, private_node, radius);
  warn_of_unknown_parameters(private_node, known_parameters());
  return options;
}

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
