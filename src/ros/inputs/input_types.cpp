#include "src/ros/inputs/input_types.hpp"

#include <stdexcept>
#include <type_traits>
#include <vector>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/marker_input.hpp"
#include "src/ros/inputs/point_cloud_input.hpp"
#include "src/ros/inputs/pose_input.hpp"

namespace fiber_proximity_ros {
namespace {

using Receiver = std::function<void(const ReceivedMessage&)>;

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

const std::vector<InputType>& table() {
  static const std::vector<InputType> types =
      make_table<fiber_proximity::FiberArray, sensor_msgs::PointCloud2, sensor_msgs::PointCloud,
                 geometry_msgs::PoseArray, nav_msgs::Path, visualization_msgs::Marker,
                 visualization_msgs::MarkerArray>();
  return types;
}

const InputType& find(const std::string& name) {
  for (const InputType& type : table()) {
    if (type.name == name) {
      return type;
    }
  }
  std::string known;
  for (const InputType& type : table()) {
    known += (known.empty() ? "" : ", ") + type.name;
  }
  throw std::invalid_argument("unknown input type '" + name + "', known are: " + known);
}

}  // namespace

bool is_marker_type(const std::string& type) { return find(type).is_marker; }

ros::Subscriber subscribe(ros::NodeHandle& node, const InputOptions& options,
                          const Receiver& receiver) {
  return find(options.type).subscribe(node, options, receiver);
}

}  // namespace fiber_proximity_ros
