#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "fiber_proximity/yaml/yaml_field.hpp"
#include "src/text/join.hpp"

namespace fiber_proximity_ros {

/// A value as a message shows it: on one line, and no more of it than the reader needs.
std::string text_of(const XmlRpc::XmlRpcValue& value);

/// A private parameter, or a key of an entry of one, as cfg/interface.yaml has it.
struct Parameter {
  std::string name;
  std::string type;           ///< bool, int, double or str; values of others are checked by code
  XmlRpc::XmlRpcValue value;  ///< where it is not set; not valid: code knows what to do
  double min;                 ///< of a number
  double max;                 ///< of a number
  std::vector<std::string> values;  ///< those of a str, empty: any; words that a number may be
  std::string must_be;              ///< what is allowed, for errors
  bool is_dynamic;                  ///< can change while the node runs
};

/// @param what as errors call it
/// @throws std::invalid_argument naming what it is, its value and what is allowed
[[noreturn]] void refuse_value(const std::string& what, const XmlRpc::XmlRpcValue& value,
                               const std::string& must_be);

/// A value as the parameter's type has it: whole numbers stand for real ones, too.
/// @throws std::invalid_argument as refuse_value()
XmlRpc::XmlRpcValue checked(const Parameter& parameter, const XmlRpc::XmlRpcValue& value,
                            const std::string& what);

/// The topics and parameters of one of our nodes, as cfg/interface.yaml has them.
struct NodeInterface {
  /// @returns null if there is none of this name
  const Parameter* find(const std::string& name) const;

  /// @throws std::out_of_range if there is none of this name
  const Parameter& at(const std::string& name) const;

  std::vector<std::string> topics;
  std::vector<Parameter> parameters;
};

/// @param node as cfg/interface.yaml names it
const NodeInterface& interface_of(const std::string& node);

/// The private parameters of one of our nodes. Reading has one way: type, limits and defaults are
/// those of cfg/interface.yaml, and so are the errors.
class Parameters {
 public:
  Parameters(const ros::NodeHandle& private_node, const NodeInterface& interface)
      : node_(private_node), interface_(interface) {}

  const ros::NodeHandle& node() const { return node_; }

  /// Reads a parameter of type bool, int, double or str; one that is not set has its default.
  /// @throws std::invalid_argument naming the parameter, its value and what is allowed: roscpp
  ///         alone would keep silent about another type, and round numbers that are not whole
  template <class Value>
  void read(const std::string& name, Value& value) const {
    using Stored = std::conditional_t<std::is_same_v<Value, std::uint32_t>, int, Value>;
    const XmlRpc::XmlRpcValue found = read_checked(name);
    value = static_cast<Value>(static_cast<const Stored&>(found));
  }

  /// Reads a number that may be a word instead: that leaves no value.
  /// @throws std::invalid_argument as read()
  void read(const std::string& name, std::optional<double>& value) const {
    const XmlRpc::XmlRpcValue found = read_checked(name);
    value.reset();
    if (found.getType() == XmlRpc::XmlRpcValue::TypeDouble) {
      value = static_cast<const double&>(found);
    }
  }

  /// Reads a list; one that is not set leaves the value as it is.
  /// @throws std::invalid_argument as read()
  template <class Value>
  void read(const std::string& name, std::vector<Value>& values) const {
    if (node_.hasParam(name) && !node_.getParam(name, values)) {
      refuse(name);
    }
  }

  /// @throws std::invalid_argument as read()
  void require_allowed(const std::string& name, const XmlRpc::XmlRpcValue& value) const;

  /// Throws what read() does, for the value that is set.
  [[noreturn]] void refuse(const std::string& name) const;
  [[noreturn]] void refuse(const std::string& name, const std::string& must_be) const;

  /// Logs a warning for each private parameter that there is not, with the one it may have been
  /// meant to be.
  void warn_of_unknown() const;

 private:
  /// As errors call it.
  std::string title(const std::string& name) const;
  XmlRpc::XmlRpcValue read_checked(const std::string& name) const;

  ros::NodeHandle node_;
  const NodeInterface& interface_;
};

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

/// A parameter as the YAML document that it may have come from.
/// @param name for errors
fiber::YamlField to_yaml(const std::string& name, const XmlRpc::XmlRpcValue& value);

}  // namespace fiber_proximity_ros
