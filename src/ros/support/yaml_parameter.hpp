#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <string>

#include "fiber_proximity/yaml/yaml_field.hpp"

namespace fiber_proximity_ros {

/// A parameter as the YAML document that it may have come from.
/// @param name for errors
fiber::YamlField to_yaml(const std::string& name, const XmlRpc::XmlRpcValue& value);

}  // namespace fiber_proximity_ros
