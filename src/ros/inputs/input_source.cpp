#include "src/ros/inputs/input_source.hpp"

#include <ros/names.h>

#include <algorithm>
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

/// Reads the value of a key, if there is one, of the type that the variable has.
template <class Value>
void read_key(const XmlRpcValue& entry, const std::string& key, const std::string& allowed,
              Value& value) {
  if (!entry.hasMember(key)) {
    return;
  }
  const XmlRpcValue& given = entry[key];
  if (given.getType() != XmlRpcValue(value).getType()) {
    refuse(key, given, allowed);
  }
  value = static_cast<const Value&>(given);
}

/// The same of a number of at least 0, which may be a whole one.
void read_size(const XmlRpcValue& entry, const std::string& key, const std::string& allowed,
               double& size) {
  if (entry.hasMember(key) && entry[key].getType() == XmlRpcValue::TypeInt) {
    size = static_cast<const int&>(entry[key]);
  } else {
    read_key(entry, key, allowed, size);
  }
  if (!(size >= 0.0 && size <= fiber::FiberAssembly::max_coordinate)) {
    refuse(key, entry[key], allowed);
  }
}

MissingPoints read_missing_points(const XmlRpcValue& entry) {
  const std::string key = "missing_points";
  const std::string allowed = "refuse, bridge or split";
  static const std::map<std::string, MissingPoints> policies{{"refuse", MissingPoints::REFUSE},
                                                             {"bridge", MissingPoints::BRIDGE},
                                                             {"split", MissingPoints::SPLIT}};
  std::string name = "refuse";
  read_key(entry, key, allowed, name);
  const auto policy = policies.find(name);
  if (policy == policies.end()) {
    refuse(key, entry[key], allowed);
  }
  return policy->second;
}

/// @returns the last key that is for markers only; empty if there is none
std::string require_known_keys(const XmlRpcValue& entry) {
  const std::vector<std::string> keys{"topic", "type", "name", "radius", "missing_points"};
  const std::vector<std::string> marker_keys{"namespace", "radius_from_marker", "weld_tolerance"};
  const auto is_among = [](const std::vector<std::string>& known, const std::string& key) {
    return std::find(known.begin(), known.end(), key) != known.end();
  };
  std::string marker_key;
  for (const auto& [key, value] : entry) {
    if (is_among(marker_keys, key)) {
      marker_key = key;
    } else if (!is_among(keys, key)) {
      throw std::invalid_argument("has the unknown key '" + key +
                                  "', known are: " + fiber::join(keys) + ", and for markers " +
                                  fiber::join(marker_keys));
    }
  }
  return marker_key;
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
  const std::string marker_key = require_known_keys(entry);
  read_key(entry, "topic", "a string", options.topic);
  read_key(entry, "type", "a string", options.type);
  read_key(entry, "name", "a string", options.name);
  read_size(entry, "radius", "a number of metres, at least 0", options.radius);
  options.missing_points = read_missing_points(entry);
  read_key(entry, "namespace", "a string", options.marker.marker_namespace);
  read_key(entry, "radius_from_marker", "true or false", options.marker.radius_from_marker);
  read_size(entry, "weld_tolerance", "a number of at least 0, a fraction of a segment's length",
            options.marker.weld_tolerance);
  if (options.topic.empty()) {
    throw std::invalid_argument("has no key 'topic'");
  }
  if (std::string reason; !ros::names::validate(options.topic, reason)) {
    refuse("topic", entry["topic"], "a ROS name: " + reason);
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
