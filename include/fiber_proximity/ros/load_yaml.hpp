#pragma once

#include <string>

#include "fiber_proximity/ros/yaml_field.hpp"

namespace fiber_proximity_ros {

/// A YAML file.
/// @throws std::invalid_argument naming the file, and the line if it is malformed, or if aliases
///         in it stand for more than ten values per byte: a few lines could stand for any number
YamlField load_yaml(const std::string& file);

/// The same from a document.
/// @param name what errors call it
YamlField parse_yaml(const std::string& text, const std::string& name);

}  // namespace fiber_proximity_ros
