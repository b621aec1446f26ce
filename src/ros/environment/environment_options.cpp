#include "src/ros/environment/environment_options.hpp"

#include <algorithm>
#include <stdexcept>

#include "src/ros/support/parameters.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

using XmlRpc::XmlRpcValue;

void refuse_unknown_keys(const ros::NodeHandle& node, const std::string& name,
                         const std::vector<std::string>& keys, const std::string& allowed) {
  XmlRpcValue map;
  node.getParam(name, map);
  if (map.getType() != XmlRpcValue::TypeStruct) {
    refuse_parameter(node, name, allowed);
  }
  for (const auto& [key, value] : map) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      std::string parameter = name;
      parameter.append("/").append(key);
      refuse_parameter(node, parameter, "left out: it must be " + allowed);
    }
  }
}

/// Leaves the corner as it is if it is not set.
void read_corner(const ros::NodeHandle& node, const std::string& name, Eigen::Vector3d& corner) {
  const std::string allowed = "a list of 3 numbers [m]";
  std::vector<double> values{corner.x(), corner.y(), corner.z()};
  read_parameter(node, name, allowed, values);
  if (values.size() != 3) {
    refuse_parameter(node, name, allowed);
  }
  corner = {values[0], values[1], values[2]};
}

void read_box(const ros::NodeHandle& node, fiber::WorldBox& box) {
  if (!node.hasParam("cloud/box")) {
    return;
  }
  refuse_unknown_keys(node, "cloud/box", {"min", "max"}, "a map of the keys min and max");
  read_corner(node, "cloud/box/min", box.min());
  read_corner(node, "cloud/box/max", box.max());
  if (!(box.min().array() <= box.max().array()).all()) {
    refuse_parameter(node, "cloud/box", "a minimum that is at most the maximum along all axes");
  }
}

/// Those that are absent keep their defaults; ~cloud may also just be true.
/// @returns none if there is no parameter ~cloud, or if it is false: then no cloud is wanted
std::optional<CloudOptions> read_cloud_options(const ros::NodeHandle& private_node) {
  if (!private_node.hasParam("cloud")) {
    return std::nullopt;
  }
  CloudOptions options;
  bool is_wanted = true;
  if (private_node.getParam("cloud", is_wanted)) {
    return is_wanted ? std::make_optional(options) : std::nullopt;
  }
  refuse_unknown_keys(private_node, "cloud", {"resolution", "box", "decay"},
                      "true, false or a map of the keys resolution, box and decay");
  constexpr double finest = 1e-4;  // [m] no depth camera sees less
  read_parameter(private_node, "cloud/resolution", finest, options.resolution);
  read_parameter(private_node, "cloud/decay", 0.0, options.decay);
  read_box(private_node, options.box);
  return options;
}

fiber::EnvironmentScene read_scene(const ros::NodeHandle& node, const MeshLoader& meshes) {
  XmlRpcValue value;
  if (!node.getParam("scene", value)) {
    return {};
  }
  if (value.getType() == XmlRpcValue::TypeStruct) {
    return fiber::read_environment_scene(to_yaml(node.resolveName("scene"), value), meshes);
  }
  if (value.getType() != XmlRpcValue::TypeString) {
    refuse_parameter(node, "scene",
                     "the path of a YAML file or a map of the keys obstacles and allowed");
  }
  const auto& file = static_cast<const std::string&>(value);
  return file.empty() ? fiber::EnvironmentScene()
                      : fiber::read_environment_scene(fiber::load_yaml(file), meshes);
}

std::vector<RobotLink> read_robot(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                                  const MeshLoader& meshes) {
  bool is_wanted = false;
  read_parameter(private_node, "robot", "true or false", is_wanted);
  std::string name = "robot_description";
  read_parameter(private_node, "robot_description_param", "the name of a parameter", name);
  if (!is_wanted) {
    return {};
  }
  std::string description;
  if (!node.getParam(name, description)) {
    throw std::invalid_argument("parameter " + private_node.resolveName("robot") +
                                " is true, but parameter " + node.resolveName(name) +
                                " is not set, it must be the URDF of the robot");
  }
  return fiber::with_context("parameter " + node.resolveName(name),
                             [&] { return read_robot(description, meshes); });
}

/// @returns false if this is not what an entry must be
bool read_marker_topic(const XmlRpcValue& entry, MarkerTopic& topic) {
  if (entry.getType() == XmlRpcValue::TypeString) {
    topic.topic = static_cast<const std::string&>(entry);
    return !topic.topic.empty();
  }
  if (entry.getType() != XmlRpcValue::TypeStruct) {
    return false;
  }
  for (const auto& [key, value] : entry) {
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

std::vector<MarkerTopic> read_marker_topics(const ros::NodeHandle& node) {
  XmlRpcValue value;
  if (!node.getParam("obstacle_markers", value)) {
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
      refuse_parameter(node, "obstacle_markers",
                       "a topic or a list of topics, each its name or a map of the keys topic and "
                       "type: visualization_msgs/MarkerArray or visualization_msgs/Marker");
    }
  }
  return topics;
}

}  // namespace

MeshLoader read_mesh_folders(const ros::NodeHandle& node) {
  std::vector<std::string> folders;
  read_parameter(node, "mesh_folders", "a list of absolute paths of folders", folders);
  return MeshLoader(folders);
}

EnvironmentOptions read_environment_options(const ros::NodeHandle& node,
                                            const ros::NodeHandle& private_node) {
  constexpr double shortest_timeout = 1e-3;
  EnvironmentOptions options;
  options.meshes = read_mesh_folders(private_node);
  options.scene = read_scene(private_node, options.meshes);
  options.robot = read_robot(node, private_node, options.meshes);
  options.cloud = read_cloud_options(private_node);
  options.marker_topics = read_marker_topics(private_node);
  read_parameter(private_node, "robot_timeout", shortest_timeout, options.robot_timeout);
  read_parameter(private_node, "obstacle_timeout", 0.0, options.obstacle_timeout);
  return options;
}

const std::vector<std::string>& environment_parameters() {
  static const std::vector<std::string> names{
      "cloud",         "mesh_folders", "obstacle_markers",       "obstacle_timeout", "robot",
      "robot_timeout", "scene",        "robot_description_param"};
  return names;
}

}  // namespace fiber_proximity_ros
