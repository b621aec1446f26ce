#include "src/ros/outputs/crossings_output.hpp"

#include <ros/console.h>

#include <stdexcept>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {

CrossingsOutput::CrossingsOutput(const ros::NodeHandle& private_node, const FixedFrame& frame,
                                 const Newcomer& on_newcomer)
    : frame_(frame), topic_(private_node, "crossings", on_newcomer) {
  read_parameters(private_node);
}

void CrossingsOutput::read_parameters(const ros::NodeHandle& private_node) {
  const NodeInterface& interface = interface_of("proximity");
  const Parameters parameters(private_node, interface);
  XmlRpc::XmlRpcValue map;
  if (!private_node.getParam("crossings", map)) {
    return;
  }
  if (map.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    parameters.refuse("crossings");
  }
  for (const auto& [key, value] : map) {
    if (interface.find("crossings/" + key) == nullptr) {
      ROS_WARN_STREAM("parameter " << private_node.resolveName("crossings/" + key)
                                   << " is unknown and not used");
    }
  }
  if (map.hasMember("direction") && map.hasMember("camera_frame")) {
    parameters.refuse("crossings", interface.at("crossings").must_be + ", not both");
  }
  parameters.read("crossings/camera_frame", camera_frame_);
  std::vector<double> direction{view_.direction.x(), view_.direction.y(), view_.direction.z()};
  parameters.read("crossings/direction", direction);
  if (direction.size() != 3) {
    parameters.refuse("crossings/direction");
  }
  view_.direction = {direction[0], direction[1], direction[2]};
  view_.is_perspective = !camera_frame_.empty();
  try {
    validate(view_);
  } catch (const std::invalid_argument&) {
    parameters.refuse("crossings/direction");
  }
}

bool CrossingsOutput::find(const fiber::FiberAssembly& fibers, const std_msgs::Header& header) {
  if (is_found_) {
    return true;
  }
  crossings_.clear();
  if (view_.is_perspective) {
    try {
      const Eigen::Isometry3d camera = frame_.latest_pose(camera_frame_, header.stamp).pose;
      view_.eye = camera.translation();
      view_.direction = camera.linear().col(2);
    } catch (const TransformUnavailable& error) {
      ROS_WARN_STREAM_THROTTLE(1.0, "no crossings: " << error.what());
      return false;
    }
  }
  finder_.find(fibers, view_, crossings_);
  is_found_ = true;
  return true;
}

void CrossingsOutput::publish(const fiber::FiberAssembly& fibers, const std_msgs::Header& header,
                              const std::vector<std::string>& names) {
  if (!find(fibers, header)) {
    return;
  }
  fiber_proximity::CrossingArray& message = topic_.message();
  message.header = header;
  message.fiber_names = names;
  message.direction = to_vector_message(view_.direction);
  message.is_perspective = view_.is_perspective;
  message.eye = to_message(view_.eye);
  message.crossings.resize(crossings_.size());
  for (std::size_t i = 0; i < crossings_.size(); ++i) {
    to_message(crossings_[i], message.crossings[i]);
  }
  topic_.publish();
}

}  // namespace fiber_proximity_ros
