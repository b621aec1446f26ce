#include "src/ros/server/server_options.hpp"

#include <ros/console.h>

#include <stdexcept>

#include "fiber_proximity/cuda/cuda_engines.hpp"
#include "fiber_proximity/paper/paper_engines.hpp"
#include "src/ros/server/query_options.hpp"
#include "src/ros/support/parameters.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::ProximityConfig;
using XmlRpc::XmlRpcValue;

const NodeInterface& interface() { return interface_of("proximity"); }

template <class Entries>
void require_allowed(const Parameters& parameters, const Entries& entries) {
  for (const auto& entry : entries) {
    parameters.require_allowed(entry.name, XmlRpcValue(entry.value));
  }
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
  for (const std::string& own : interface().topics) {
    if (node.resolveName(input.topic) == private_node.resolveName(own)) {
      throw std::invalid_argument("key 'topic' is " + input.topic +
                                  ", it must be none of the node's own topics");
    }
  }
}

void read_inputs(const ros::NodeHandle& public_node, const Parameters& parameters, double radius,
                 FiberInputOptions& options) {
  const ros::NodeHandle& node = parameters.node();
  XmlRpcValue list;
  if (!node.getParam("inputs", list)) {
    XmlRpcValue fibers;
    fibers["topic"] = "fibers";
    InputOptions input = read_input_options(fibers, radius);
    input.where = "the default of parameter " + node.resolveName("inputs");
    options.inputs = {input};
    return;
  }
  if (list.getType() != XmlRpcValue::TypeArray) {
    parameters.refuse("inputs");
  }
  if (list.size() == 0) {
    ROS_WARN_STREAM("parameter " << node.resolveName("inputs")
                                 << " is an empty list: no fibres will arrive");
  }
  for (int i = 0; i < list.size(); ++i) {
    const std::string where =
        "parameter " + node.resolveName("inputs") + ", entry " + std::to_string(i);
    try {
      InputOptions input = read_input_options(list[i], radius);
      input.where = where;
      input.marker.timeout = options.timing.input_timeout;
      require_foreign_topic(input, public_node, node);
      require_new_name(input, options.inputs);
      options.inputs.push_back(input);
    } catch (const std::invalid_argument& error) {
      ROS_ERROR_STREAM(where << " is left out: " << error.what());
      options.left_out.push_back(
          {"inputs", where, ros::Time::now(), std::string("left out: ") + error.what(), true});
    }
  }
}

/// Checks the parameters that the engine judges.
void check_engine(const ros::NodeHandle& private_node, const ServerOptions& options) {
  const std::string prefix = "parameter " + private_node.getNamespace() + "/";
  fiber::with_context(prefix + "engine", [&] { fiber::make_engine(options.engine); });
  try {
    fiber::make_engine(options.engine, options.engine_options);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(prefix + error.what());  // which begins with the name
  }
}

/// Reads the parameters that can change while the node runs. dynamic_reconfigure alone would keep
/// silent about bad ones, and take the default or the nearest value.
/// @throws std::invalid_argument naming the parameter, its value and what is allowed
ProximityConfig read_dynamic_parameters(const ros::NodeHandle& private_node) {
  const Parameters parameters(private_node, interface());
  for (const Parameter& parameter : interface().parameters) {
    XmlRpcValue value;
    if (parameter.is_dynamic && private_node.getParam(parameter.name, value)) {
      parameters.require_allowed(parameter.name, value);
    }
  }
  ProximityConfig config = ProximityConfig::__getDefault__();
  config.__fromServer__(private_node);
  check(private_node, config);
  return config;
}

}  // namespace

ServerOptions read_server_options(const ros::NodeHandle& node,
                                  const ros::NodeHandle& private_node) {
  fiber::register_paper_engines();
  fiber::register_cuda_engines();
  const Parameters parameters(private_node, interface());
  ServerOptions options;
  double radius = 0.0;
  parameters.read("engine", options.engine);
  parameters.read("threads", options.engine_options.threads);
  parameters.read("skin", options.engine_options.skin);
  parameters.read("fixed_frame", options.fibers.fixed_frame);
  parameters.read("radius", radius);
  parameters.read("tf_timeout", options.fibers.timing.tf_timeout);
  parameters.read("input_timeout", options.fibers.timing.input_timeout);
  parameters.read("max_stamp_ahead", options.fibers.timing.max_stamp_ahead);
  parameters.read("synchronize", options.fibers.timing.synchronize);
  parameters.read("synchronize_slop", options.fibers.timing.synchronize_slop);
  std::string latency;
  parameters.read("latency_compensation", latency);
  options.fibers.timing.bounds_latency = latency == "bounds";
  parameters.read("marker_rate", options.marker_rate);
  parameters.read("heartbeat", options.heartbeat);
  // Read by diagnostic_updater, which keeps silent about what is none.
  double diagnostic_period = 0.0;
  parameters.read("diagnostic_period", diagnostic_period);
  check_engine(private_node, options);
  options.config = read_dynamic_parameters(private_node);
  read_inputs(node, parameters, radius, options.fibers);
  parameters.warn_of_unknown();
  return options;
}

void check(const ros::NodeHandle& private_node, const ProximityConfig& config) {
  const Parameters parameters(private_node, interface());
  dynamic_reconfigure::Config values;
  config.__toMessage__(values);
  require_allowed(parameters, values.ints);
  require_allowed(parameters, values.doubles);
  require_allowed(parameters, values.strs);
  try {
    to_query_options(config);
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument("parameter " + private_node.getNamespace() + "/" + error.what());
  }
}

}  // namespace fiber_proximity_ros
