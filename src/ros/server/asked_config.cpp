#include "src/ros/server/asked_config.hpp"

#include "src/ros/support/parameters.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::ProximityConfig;

/// @returns why these are no values of parameters of this type that can change; empty if they are
template <class Entries>
std::string not_of_type(const std::string& type, const Entries& entries) {
  for (const auto& entry : entries) {
    const Parameter* const parameter = interface_of("proximity").find(entry.name);
    if (parameter == nullptr || !parameter->is_dynamic) {
      return "there is no parameter " + entry.name;
    }
    if (parameter->type != type) {
      return "parameter " + entry.name + " is a value of type " + type + ", it must be " +
             parameter->must_be;
    }
  }
  return "";
}

template <class... Lists>
std::set<std::string> names_of(const Lists&... lists) {
  std::set<std::string> names;
  const auto add = [&names](const auto& entries) {
    for (const auto& entry : entries) {
      names.insert(entry.name);
    }
  };
  (add(lists), ...);
  return names;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp)
bool AskedConfig::__fromMessage__(dynamic_reconfigure::Config& message) {
  for (const std::string& problem :
       {not_of_type("bool", message.bools), not_of_type("int", message.ints),
        not_of_type("double", message.doubles), not_of_type("str", message.strs)}) {
    if (!problem.empty()) {
      problem_ = problem;
      return false;
    }
  }
  problem_.clear();
  add_names(names_of(message.bools, message.ints, message.doubles, message.strs));
  return ProximityConfig::__fromMessage__(message);
}

// NOLINTNEXTLINE(bugprone-reserved-identifier, cert-dcl37-c, cert-dcl51-cpp)
void AskedConfig::__fromServer__(const ros::NodeHandle& private_node) {
  std::set<std::string> names;
  for (const auto& parameter : __getParamDescriptions__()) {
    if (private_node.hasParam(parameter->name)) {
      names.insert(parameter->name);
    }
  }
  add_names(names);
  ProximityConfig::__fromServer__(private_node);
}

void AskedConfig::add_names(std::set<std::string> names) {
  if (names.size() == __getParamDescriptions__().size()) {
    named_.clear();
  } else {
    named_.merge(names);
  }
}

}  // namespace fiber_proximity_ros
