#include "src/ros/inputs/input_source.hpp"

#include <ros/names.h>

#include <map>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "src/ros/inputs/point_messages.hpp"
#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {
namespace {

template <class Message>
constexpr bool is_marker = std::is_same_v<Message, visualization_msgs::Marker> ||
                           std::is_same_v<Message, visualization_msgs::MarkerArray>;

template <class Message>
bool read(const Message& message, const MarkerInputOptions& marker, FiberBuffer& chains) {
  if constexpr (is_marker<Message>) {
    return to_chains(message, marker, chains);
  } else {
    to_chains(message, chains);
    return true;
  }
}

/// Publishers number the messages of types that begin with a header, and no others.
template <class Message>
std::optional<std::uint32_t> sequence_of(const Message& message) {
  if constexpr (ros::message_traits::HasHeader<Message>::value) {
    return message.header.seq;
  } else {
    return std::nullopt;
  }
}

template <class Message>
ros::Subscriber subscribe_to(ros::NodeHandle& node, const InputOptions& options,
                             const Receiver& receiver) {
  using Event = ros::MessageEvent<const Message>;
  const boost::function<void(const Event&)> callback =
      [receiver, marker = options.marker](const Event& event) {
        const Message& message = *event.getConstMessage();
        receiver({[&](FiberBuffer& chains) { return read(message, marker, chains); },
                  event.getPublisherName(), sequence_of(message)});
      };
  return node.subscribe<Message, const Event&>(options.topic, 1, callback, ros::VoidConstPtr(),
                                               ros::TransportHints().tcpNoDelay());
}

struct InputType {
  std::string name;
  bool is_marker;
  ros::Subscriber (*subscribe)(ros::NodeHandle&, const InputOptions&, const Receiver&);
};

template <class... Messages>
std::vector<InputType> make_table() {
  return {
      {ros::message_traits::datatype<Messages>(), is_marker<Messages>, subscribe_to<Messages>}...};
}

const InputType& find(const std::string& name) {
  static const std::vector<InputType> types =
      make_table<fiber_proximity::FiberArray, sensor_msgs::PointCloud2, sensor_msgs::PointCloud,
                 geometry_msgs::PoseArray, nav_msgs::Path, visualization_msgs::Marker,
                 visualization_msgs::MarkerArray>();
  return find_by_name(types, "input type", name);
}

using XmlRpc::XmlRpcValue;

[[noreturn]] void refuse(const std::string& key, const XmlRpcValue& value,
                         const std::string& allowed) {
  throw std::invalid_argument("key '" + key + "' is " + text_of(value) + ", it must be " + allowed);
}

template <class Value>
const Value& read_value(const std::string& key, const XmlRpcValue& value, XmlRpcValue::Type type,
                        const std::string& allowed) {
  if (value.getType() != type) {
    refuse(key, value, allowed);
  }
  return static_cast<const Value&>(value);
}

std::string read_string(const std::string& key, const XmlRpcValue& value) {
  return read_value<std::string>(key, value, XmlRpcValue::TypeString, "a string");
}

double read_number(const std::string& key, const XmlRpcValue& value, const std::string& allowed) {
  double number = -1.0;
  if (value.getType() == XmlRpcValue::TypeDouble) {
    number = static_cast<const double&>(value);
  } else if (value.getType() == XmlRpcValue::TypeInt) {
    number = static_cast<const int&>(value);
  }
  if (!(number >= 0.0 && number <= fiber::FiberAssembly::max_coordinate)) {
    refuse(key, value, allowed);
  }
  return number;
}

MissingPoints read_missing_points(const std::string& key, const XmlRpcValue& value) {
  const std::string allowed = "refuse, bridge or split";
  static const std::map<std::string, MissingPoints> policies{{"refuse", MissingPoints::REFUSE},
                                                             {"bridge", MissingPoints::BRIDGE},
                                                             {"split", MissingPoints::SPLIT}};
  const auto policy =
      policies.find(read_value<std::string>(key, value, XmlRpcValue::TypeString, allowed));
  if (policy == policies.end()) {
    refuse(key, value, allowed);
  }
  return policy->second;
}

/// @returns false if there is no such key
bool read_marker_key(const std::string& key, const XmlRpcValue& value, MarkerInputOptions& marker) {
  if (key == "namespace") {
    marker.marker_namespace = read_string(key, value);
  } else if (key == "radius_from_marker") {
    marker.radius_from_marker =
        read_value<bool>(key, value, XmlRpcValue::TypeBoolean, "true or false");
  } else if (key == "weld_tolerance") {
    marker.weld_tolerance =
        read_number(key, value, "a number of at least 0, a fraction of a segment's length");
  } else {
    return false;
  }
  return true;
}

/// @returns false if there is no such key
bool read_key(const std::string& key, const XmlRpcValue& value, InputOptions& options) {
  if (key == "topic") {
    options.topic = read_string(key, value);
    std::string reason;
    if (!ros::names::validate(options.topic, reason)) {
      refuse(key, value, "a ROS name: " + reason);
    }
  } else if (key == "type") {
    options.type = read_string(key, value);
  } else if (key == "name") {
    options.name = read_string(key, value);
  } else if (key == "radius") {
    options.radius = read_number(key, value, "a number of metres, at least 0");
  } else if (key == "missing_points") {
    options.missing_points = read_missing_points(key, value);
  } else {
    return false;
  }
  return true;
}

}  // namespace

ros::Subscriber subscribe(ros::NodeHandle& node, const InputOptions& options,
                          const Receiver& receiver) {
  return find(options.type).subscribe(node, options, receiver);
}

InputOptions read_input_options(const XmlRpcValue& entry, double default_radius) {
  if (entry.getType() != XmlRpcValue::TypeStruct) {
    throw std::invalid_argument("is " + text_of(entry) +
                                ", it must be a map with the key 'topic' at least");
  }
  InputOptions options;
  options.radius = default_radius;
  std::string marker_key;
  for (const auto& [key, value] : entry) {
    if (read_key(key, value, options)) {
      continue;
    }
    if (!read_marker_key(key, value, options.marker)) {
      throw std::invalid_argument(
          "has the unknown key '" + key +
          "', known are: topic, type, name, radius, missing_points, and for markers namespace, "
          "radius_from_marker, weld_tolerance");
    }
    marker_key = key;
  }
  if (options.topic.empty()) {
    throw std::invalid_argument("has no key 'topic'");
  }
  const bool is_marker = find(options.type).is_marker;
  if (!marker_key.empty() && !is_marker) {
    throw std::invalid_argument("key '" + marker_key + "' is for markers only, not for type '" +
                                options.type + "'");
  }
  if (options.name.empty()) {
    options.name = options.topic;
  }
  return options;
}

}  // namespace fiber_proximity_ros
