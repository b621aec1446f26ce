#pragma once

#include <string>

#include "src/ros/inputs/fixed_frame.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {

/// fiber::with_context(), for functions that may miss a transform, too.
template <class Function>
auto naming(const std::string& what, const Function& function) {
  try {
    return fiber::with_context(what, function);
  } catch (const TransformUnavailable& error) {
    throw TransformUnavailable(what + ": " + error.what());
  }
}

}  // namespace fiber_proximity_ros
