#include "src/ros/server/server_options.hpp"

#include <ros/console.h>

#include <stdexcept>

#include "src/ros/environment/environment_options.hpp"
#include "src/ros/server/dynamic_parameters.hpp"
#include "src/ros/support/parameters.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

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
  XmlRpc::XmlRpcValue list;
  if (!node.getParam("inputs", list)) {
    return {default_input};
  }
  if (list.getType() != XmlRpc::XmlRpcValue::TypeArray) {
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
  for (const auto& parameter : fiber_proximity::ProximityConfig::__getParamDescriptions__()) {
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

}  // namespace fiber_proximity_ros
