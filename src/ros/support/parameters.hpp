#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cstdint>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "fiber_proximity/yaml/yaml_field.hpp"
#include "src/text/join.hpp"

namespace fiber_proximity_ros {

/// A value as a message shows it: on one line, and no more of it than the reader needs.
std::string text_of(const XmlRpc::XmlRpcValue& value);

/// @throws std::invalid_argument naming the parameter, its value and what is allowed
[[noreturn]] void refuse_parameter(const ros::NodeHandle& node, const std::string& name,
                                   const std::string& allowed);

/// Reads a parameter; one that is not set leaves the value as it is.
/// @throws std::invalid_argument if it is of another type: roscpp alone would keep silent
template <class Value>
void read_parameter(const ros::NodeHandle& node, const std::string& name,
                    const std::string& allowed, Value& value) {
  if (node.hasParam(name) && !node.getParam(name, value)) {
    refuse_parameter(node, name, allowed);
  }
}

/// What a number may be, as a message says it: whether it has an upper limit, too.
/// @param kind as "a number"
template <class Number>
std::string allowed_range(const std::string& kind, Number least, Number most) {
  std::ostringstream text;
  if (most < std::numeric_limits<Number>::max()) {
    text << kind << " from " << least << " to " << most;
  } else {
    text << kind << " of at least " << least;
  }
  return text.str();
}

/// What a number may be; without an upper limit at least this.
struct Limits {
  Limits(double from, double to = std::numeric_limits<double>::infinity())
      : least(from), most(to) {}

  double least;
  double most;
};

/// Reads a finite number within these limits; a whole number is one, too.
/// @throws std::invalid_argument if it is anything else
void read_parameter(const ros::NodeHandle& node, const std::string& name, const Limits& limits,
                    double& value);

/// Reads a whole number of at least this limit; roscpp alone would round others.
/// @throws std::invalid_argument if it is anything else
void read_parameter(const ros::NodeHandle& node, const std::string& name, int least, int& value);

/// Reads a whole number of at least 0.
/// @throws std::invalid_argument if it is anything else
void read_parameter(const ros::NodeHandle& node, const std::string& name, std::uint32_t& value);

/// The entry of this name.
/// @param what as "format"
/// @throws std::invalid_argument if there is none, with the names that are known
template <class Entry>
const Entry& find_by_name(const std::vector<Entry>& entries, const std::string& what,
                          const std::string& name) {
  std::vector<std::string> known;
  for (const Entry& entry : entries) {
    if (entry.name == name) {
      return entry;
    }
    known.push_back(entry.name);
  }
  throw std::invalid_argument("unknown " + what + " '" + name +
                              "', known are: " + fiber::join(known));
}

/// Logs a warning for each private parameter that is none of these, with the known one it may have
/// been meant to be.
void warn_of_unknown_parameters(const ros::NodeHandle& private_node,
                                const std::vector<std::string>& known);

/// A parameter as the YAML document that it may have come from.
/// @param name for errors
fiber::YamlField to_yaml(const std::string& name, const XmlRpc::XmlRpcValue& value);

}  // namespace fiber_proximity_ros
