#include "src/ros/environment/environment_options.hpp"

#include <stdexcept>

#include "src/ros/support/parameters.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

using XmlRpc::XmlRpcValue;

const NodeInterface& interface() { return interface_of("proximity"); }

/// Refuses keys of a map that cfg/interface.yaml does not know.
void refuse_unknown_keys(const Parameters& parameters, const std::string& name) {
  XmlRpcValue map;
  parameters.node().getParam(name, map);
  if (map.getType() != XmlRpcValue::TypeStruct) {
    parameters.refuse(name);
  }
  for (const auto& [key, value] : map) {
    std::string entry = name;
    entry.append("/").append(key);
    if (interface().find(entry) == nullptr) {
      parameters.refuse(entry, "left out: it must be " + interface().at(name).must_be);
    }
  }
}

/// Leaves the corner as it is if it is not set.
void read_corner(const Parameters& parameters, const std::string& name, Eigen::Vector3d& corner) {
  std::vector<double> values{corner.x(), corner.y(), corner.z()};
  parameters.read(name, values);
  if (values.size() != 3) {
    parameters.refuse(name);
  }
  corner = {values[0], values[1], values[2]};
}

void read_box(const Parameters& parameters, fiber::WorldBox& box) {
  if (!parameters.node().hasParam("cloud/box")) {
    return;
  }
  refuse_unknown_keys(parameters, "cloud/box");
  read_corner(parameters, "cloud/box/min", box.min());
  read_corner(parameters, "cloud/box/max", box.max());
  if (!(box.min().array() <= box.max().array()).all()) {
    parameters.refuse("cloud/box", "a minimum that is at most the maximum along all axes");
  }
}

/// Options that are absent keep their defaults; ~cloud may also just be true.
/// @returns none if there is no parameter ~cloud, or if it is false: then no cloud is wanted
std::optional<CloudOptions> read_cloud_options(const Parameters& parameters) {
  bool is_wanted = parameters.node().hasParam("cloud");
  const bool is_map = is_wanted && !parameters.node().getParam("cloud", is_wanted);
  if (!is_wanted) {
    return std::nullopt;
  }
  if (is_map) {
    refuse_unknown_keys(parameters, "cloud");
  }
  CloudOptions options;
  parameters.read("cloud/resolution", options.resolution);
  parameters.read("cloud/decay", options.decay);
  parameters.read("cloud/required", options.required);
  parameters.read("cloud/timeout", options.timeout);
  read_box(parameters, options.box);
  return options;
}

fiber::EnvironmentScene read_scene(const Parameters& parameters, const MeshLoader& meshes) {
  const ros::NodeHandle& node = parameters.node();
  XmlRpcValue value;
  if (!node.getParam("scene", value)) {
    return {};
  }
  if (value.getType() == XmlRpcValue::TypeStruct) {
    return fiber::read_environment_scene(to_yaml(node.resolveName("scene"), value), meshes);
  }
  if (value.getType() != XmlRpcValue::TypeString) {
    parameters.refuse("scene");
  }
  const auto& file = static_cast<const std::string&>(value);
  return file.empty() ? fiber::EnvironmentScene()
                      : fiber::with_context("parameter " + node.resolveName("scene"), [&] {
                          return fiber::read_environment_scene(fiber::load_yaml(file), meshes);
                        });
}

std::vector<RobotLink> read_robot(const ros::NodeHandle& node, const Parameters& parameters,
                                  const MeshLoader& meshes) {
  bool is_wanted = false;
  parameters.read("robot", is_wanted);
  std::string name;
  parameters.read("robot_description_param", name);
  if (!is_wanted) {
    return {};
  }
  const std::string description =
      fiber::with_context("parameter " + parameters.node().resolveName("robot") + " is true",
                          [&] { return robot_description(node, name); });
  return fiber::with_context("parameter " + node.resolveName(name),
                             [&] { return read_robot(description, meshes); });
}

/// Reads an entry of ~obstacle_markers.
/// @returns false if the entry is malformed
bool read_marker_topic(const XmlRpcValue& entry, MarkerTopic& topic) {
  if (entry.getType() == XmlRpcValue::TypeString) {
    topic.topic = static_cast<const std::string&>(entry);
    return !topic.topic.empty();
  }
  if (entry.getType() != XmlRpcValue::TypeStruct) {
    return false;
  }
  for (const auto& [key, value] : entry) {
    if (key == "required" && value.getType() == XmlRpcValue::TypeBoolean) {
      topic.required = static_cast<const bool&>(value);
      continue;
    }
    if (value.getType() != XmlRpcValue::TypeString) {
      return false;
    }
    const auto& text = static_cast<const std::string&>(value);
    if (key == "topic") {
      topic.topic = text;
    } else if (key == "type" &&
               (text == "visualization_msgs/MarkerArray" || text == "visualization_msgs/Marker")) {
      topic.is_array = text == "visualization_msgs/MarkerArray";
    } else {
      return false;
    }
  }
  return !topic.topic.empty();
}

std::vector<MarkerTopic> read_marker_topics(const Parameters& parameters) {
  XmlRpcValue value;
  if (!parameters.node().getParam("obstacle_markers", value)) {
    return {};
  }
  XmlRpcValue list;
  if (value.getType() == XmlRpcValue::TypeArray) {
    list = value;
  } else {
    list[0] = value;
  }
  std::vector<MarkerTopic> topics(static_cast<std::size_t>(list.size()));
  for (std::size_t i = 0; i < topics.size(); ++i) {
    if (!read_marker_topic(list[static_cast<int>(i)], topics[i])) {
      parameters.refuse("obstacle_markers");
    }
  }
  return topics;
}

}  // namespace

MeshLoader read_mesh_folders(const Parameters& parameters) {
  std::vector<std::string> folders;
  parameters.read("mesh_folders", folders);
  return fiber::with_context("parameter " + parameters.node().resolveName("mesh_folders"),
                             [&] { return MeshLoader(folders); });
}

EnvironmentOptions read_environment_options(const ros::NodeHandle& node,
                                            const ros::NodeHandle& private_node) {
  const Parameters parameters(private_node, interface());
  EnvironmentOptions options;
  options.meshes = read_mesh_folders(parameters);
  options.scene = read_scene(parameters, options.meshes);
  options.robot = read_robot(node, parameters, options.meshes);
  options.cloud = read_cloud_options(parameters);
  options.marker_topics = read_marker_topics(parameters);
  parameters.read("obstacles_required", options.obstacles_required);
  parameters.read("tf_timeout", options.tf_timeout);
  parameters.read("max_stamp_ahead", options.max_stamp_ahead);
  parameters.read("robot_timeout", options.robot_timeout);
  parameters.read("obstacle_timeout", options.obstacle_timeout);
  return options;
}

}  // namespace fiber_proximity_ros
