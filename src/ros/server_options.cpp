#include "fiber_proximity/ros/server_options.hpp"

#include <ros/console.h>

#include <algorithm>
#include <stdexcept>

#include "fiber_proximity/ProximityConfig.h"
#include "fiber_proximity/ros/environment_options.hpp"
#include "fiber_proximity/ros/parameters.hpp"

namespace fiber_proximity_ros {
namespace {

std::vector<InputOptions> read_inputs(const ros::NodeHandle& node, double radius) {
  InputOptions default_input;
  default_input.topic = "fibers";
  default_input.name = default_input.topic;
  default_input.radius = radius;
  XmlRpc::XmlRpcValue list;
  if (!node.getParam("inputs", list)) {
    return {default_input};
  }
  if (list.getType() != XmlRpc::XmlRpcValue::TypeArray) {
    refuse_parameter(node, "inputs", "a list of maps with the key 'topic' at least");
  }
  std::vector<InputOptions> inputs;
  for (int i = 0; i < list.size(); ++i) {
    try {
      inputs.push_back(read_input_options(list[i], radius));
    } catch (const std::invalid_argument& error) {
      ROS_ERROR_STREAM("parameter " << node.resolveName("inputs") << ", entry " << i
                                    << " is left out: " << error.what());
    }
  }
  return inputs;
}

void warn_of_unknown_parameters(const ros::NodeHandle& node) {
  std::vector<std::string> known{
      "engine",         "threads",       "skin",        "fixed_frame", "inputs",
      "radius",         "input_timeout", "marker_rate", "tf_timeout",  "diagnostic_period",
      "simplification", "crossings"};
  known.insert(known.end(), environment_parameters().begin(), environment_parameters().end());
  for (const auto& parameter : fiber_proximity::ProximityConfig::__getParamDescriptions__()) {
    known.push_back(parameter->name);
  }
  std::vector<std::string> names;
  node.getParamNames(names);
  const std::string prefix = node.getNamespace() + "/";
  for (const std::string& name : names) {
    if (name.rfind(prefix, 0) != 0) {
      continue;
    }
    const std::string own =
        name.substr(prefix.size(), name.find('/', prefix.size()) - prefix.size());
    if (std::find(known.begin(), known.end(), own) == known.end()) {
      ROS_WARN_STREAM("parameter " << name << " is unknown and not used");
    }
  }
}

}  // namespace

ServerOptions read_server_options(const ros::NodeHandle& private_node) {
  constexpr double shortest_timeout = 1e-3;
  constexpr double slowest_rate = 1e-3;
  ServerOptions options;
  double radius = InputOptions().radius;
  read_parameter(private_node, "engine", "a string", options.engine);
  read_parameter(private_node, "threads", options.engine_options.threads);
  read_parameter(private_node, "skin", 0.0, options.engine_options.skin);
  read_parameter(private_node, "simplification", 0.0, options.engine_options.simplification);
  read_parameter(private_node, "fixed_frame", "a string", options.fixed_frame);
  read_parameter(private_node, "radius", 0.0, radius);
  read_parameter(private_node, "tf_timeout", 0.0, options.timing.tf_timeout);
  read_parameter(private_node, "input_timeout", shortest_timeout, options.timing.input_timeout);
  read_parameter(private_node, "marker_rate", slowest_rate, options.marker_rate);
  options.inputs = read_inputs(private_node, radius);
  warn_of_unknown_parameters(private_node);
  return options;
}

}  // namespace fiber_proximity_ros
