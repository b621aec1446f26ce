#include "src/ros/environment/cloud_options.hpp"

#include <algorithm>
#include <vector>

#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {
namespace {

const char* const allowed_keys = "true, false or a map of the keys resolution, box and decay";

void refuse_unknown_keys(const ros::NodeHandle& node, const std::string& name,
                         const std::vector<std::string>& keys, const std::string& allowed) {
  XmlRpc::XmlRpcValue map;
  node.getParam(name, map);
  if (map.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
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

}  // namespace

std::optional<CloudOptions> read_cloud_options(const ros::NodeHandle& private_node) {
  if (!private_node.hasParam("cloud")) {
    return std::nullopt;
  }
  CloudOptions options;
  bool is_wanted = true;
  if (private_node.getParam("cloud", is_wanted)) {
    return is_wanted ? std::make_optional(options) : std::nullopt;
  }
  refuse_unknown_keys(private_node, "cloud", {"resolution", "box", "decay"}, allowed_keys);
  constexpr double finest = 1e-4;  // [m] no depth camera sees less
  read_parameter(private_node, "cloud/resolution", finest, options.resolution);
  read_parameter(private_node, "cloud/decay", 0.0, options.decay);
  read_box(private_node, options.box);
  return options;
}

}  // namespace fiber_proximity_ros
