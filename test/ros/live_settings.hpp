#pragma once

#include <dynamic_reconfigure/Reconfigure.h>

#include "fiber_proximity/ProximityConfig.h"
#include "test/ros/node_test.hpp"

namespace node_test {

/// Asks the running node for these values.
/// @returns those in use then
inline fiber_proximity::ProximityConfig set_parameters(
    const fiber_proximity::ProximityConfig& config) {
  dynamic_reconfigure::Reconfigure call;
  config.__toMessage__(call.request.config);
  EXPECT_TRUE(call_service("/proximity/set_parameters", call));
  fiber_proximity::ProximityConfig in_use;
  EXPECT_TRUE(in_use.__fromMessage__(call.response.config));
  return in_use;
}

}  // namespace node_test
