#pragma once

#include <stdexcept>
#include <string>

#include "fiber_proximity/ros/fixed_frame.hpp"

namespace fiber_proximity_ros {

/// Runs a function; an error of its names what it was about, too.
template <class Function>
auto naming(const std::string& what, const Function& function) {
  try {
    return function();
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(what + ": " + error.what());
  } catch (const TransformUnavailable& error) {
    throw TransformUnavailable(what + ": " + error.what());
  }
}

}  // namespace fiber_proximity_ros
