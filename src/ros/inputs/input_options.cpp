#include "src/ros/inputs/input_options.hpp"

#include <ros/names.h>

#include <stdexcept>

#include "src/ros/inputs/input_types.hpp"
#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {
namespace {

using XmlRpc::XmlRpcValue;

[[noreturn]] void refuse(const std::string& key, const XmlRpcValue& value,
                         const std::string& allowed) {
  throw std::invalid_argument("key '" + key + "' is " + text_of(value) + ", it must be " + allowed);
}

std::string read_string(const std::string& key, const XmlRpcValue& value) {
  if (value.getType() != XmlRpcValue::TypeString) {
    refuse(key, value, "a string");
  }
  return static_cast<const std::string&>(value);
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
  if (value.getType() != XmlRpcValue::TypeString) {
    refuse(key, value, allowed);
  }
  const std::optional<MissingPoints> policy =
      missing_points_from_name(static_cast<const std::string&>(value));
  if (!policy) {
    refuse(key, value, allowed);
  }
  return *policy;
}

bool read_bool(const std::string& key, const XmlRpcValue& value) {
  if (value.getType() != XmlRpcValue::TypeBoolean) {
    refuse(key, value, "true or false");
  }
  return static_cast<const bool&>(value);
}

/// @returns false if there is no such key
bool read_marker_key(const std::string& key, const XmlRpcValue& value, MarkerInputOptions& marker) {
  if (key == "namespace") {
    marker.marker_namespace = read_string(key, value);
  } else if (key == "radius_from_marker") {
    marker.radius_from_marker = read_bool(key, value);
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
  const bool is_marker = is_marker_type(options.type);
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
