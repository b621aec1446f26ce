#include "src/ros/inputs/input_source.hpp"

#include <ros/names.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <map>
#include <memory>
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

/// Lists the markers of a message. Each keeps the message alive.
std::vector<MarkerInput::MarkerPtr> markers_of(const visualization_msgs::Marker::ConstPtr& one) {
  return {MarkerInput::MarkerPtr(one.get(), [one](const void* /*marker*/) {})};
}

std::vector<MarkerInput::MarkerPtr> markers_of(
    const visualization_msgs::MarkerArray::ConstPtr& array) {
  const std::shared_ptr<const visualization_msgs::MarkerArray> all(
      array.get(), [array](const void* /*markers*/) {});
  std::vector<MarkerInput::MarkerPtr> markers;
  for (const visualization_msgs::Marker& marker : array->markers) {
    markers.emplace_back(all, &marker);
  }
  return markers;
}

/// The number of a message. Publishers number only messages of types that begin with a header.
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
  boost::function<void(const Event&)> callback;
  if constexpr (is_marker<Message>) {
    auto input = std::make_shared<MarkerInput>(options.marker);
    callback = [receiver, input](const Event& event) {
      receiver({[&](FiberBuffer& fibers) {
                  return input->read(markers_of(event.getConstMessage()), ros::Time::now(), fibers);
                },
                [&] { input->keep(); }, event.getPublisherName(),
                sequence_of(*event.getConstMessage())});
    };
  } else {
    callback = [receiver](const Event& event) {
      const Message& message = *event.getConstMessage();
      receiver({[&](FiberBuffer& fibers) {
                  to_chains(message, fibers);
                  return ReadResult();
                },
                [] {}, event.getPublisherName(), sequence_of(message)});
    };
  }
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

/// Reads the value of a key, which is the default where there is none.
template <class Value>
void read_key(const XmlRpcValue& entry, const std::string& key, Value& value) {
  const Parameter& known = interface_of("input").at(key);
  XmlRpcValue found = known.value;
  if (entry.hasMember(key)) {
    found = checked(known, entry[key], "key '" + key + "'");
  }
  using Stored = std::conditional_t<std::is_same_v<Value, std::uint32_t>, int, Value>;
  if (found.valid()) {
    value = static_cast<Value>(static_cast<const Stored&>(found));
  }
}

MissingPoints read_missing_points(const XmlRpcValue& entry) {
  static const std::map<std::string, MissingPoints> policies{{"refuse", MissingPoints::REFUSE},
                                                             {"bridge", MissingPoints::BRIDGE},
                                                             {"split", MissingPoints::SPLIT}};
  std::string name;
  read_key(entry, "missing_points", name);
  return policies.at(name);
}

void require_known_keys(const XmlRpcValue& entry) {
  const NodeInterface& known = interface_of("input");
  for (const auto& [key, value] : entry) {
    if (known.find(key) == nullptr) {
      std::vector<std::string> names;
      for (const Parameter& parameter : known.parameters) {
        names.push_back(parameter.name);
      }
      throw std::invalid_argument("has the unknown key '" + key +
                                  "', known are: " + fiber::join(names));
    }
  }
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
  require_known_keys(entry);
  read_key(entry, "topic", options.topic);
  read_key(entry, "type", options.type);
  read_key(entry, "name", options.name);
  read_key(entry, "radius", options.radius);
  read_key(entry, "uncertainty", options.uncertainty);
  read_key(entry, "close_rings", options.close_rings);
  options.missing_points = read_missing_points(entry);
  read_key(entry, "required", options.required);
  read_key(entry, "max_pairs", options.cost.max_pairs);
  read_key(entry, "max_time", options.cost.max_time);
  read_key(entry, "namespace", options.marker.marker_namespace);
  read_key(entry, "radius_from_marker", options.marker.radius_from_marker);
  read_key(entry, "weld_tolerance", options.marker.weld_tolerance);
  if (options.topic.empty()) {
    throw std::invalid_argument("has no key 'topic'");
  }
  if (std::string reason; !ros::names::validate(options.topic, reason)) {
    refuse_value("key 'topic'", entry["topic"], "a ROS name: " + reason);
  }
  const bool is_marker = find(options.type).is_marker;
  for (const char* key : {"namespace", "radius_from_marker", "weld_tolerance"}) {
    if (entry.hasMember(key) && !is_marker) {
      throw std::invalid_argument("key '" + std::string(key) +
                                  "' is for markers only, not for type '" + options.type + "'");
    }
  }
  if (options.name.empty()) {
    options.name = options.topic;
  }
  options.marker.name = options.name;
  return options;
}

}  // namespace fiber_proximity_ros
