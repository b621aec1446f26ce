#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/ApplyObstacles.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace node_test {

/// Asks the running node about its environment.
class EnvironmentServicesTest : public NodeTest {
 protected:
  template <class Service>
  static typename Service::Response call(const std::string& name,
                                         const typename Service::Request& request) {
    Service service;
    service.request = request;
    EXPECT_TRUE(call_service("/proximity/" + name, service));
    return service.response;
  }

  static void apply(const std::vector<fiber_proximity::Obstacle>& obstacles) {
    fiber_proximity::ApplyObstacles::Request request;
    request.obstacles = obstacles;
    const auto response = call<fiber_proximity::ApplyObstacles>("apply_obstacles", request);
    EXPECT_TRUE(response.success) << response.message;
  }

  static fiber_proximity::QueryProximity::Response query(
      const fiber_proximity::QueryProximity::Request& request) {
    return call<fiber_proximity::QueryProximity>("query", request);
  }

  /// A fibre along y at x, from the first y to the second.
  static fiber_proximity::FiberArray fiber(double x, double begin, double end) {
    fiber_proximity::FiberArray fiber =
        test_messages::fiber_array(test_messages::header("world"),
                                   {{x, begin, 0.0}, {x, 0.5 * (begin + end), 0.0}, {x, end, 0.0}});
    fiber.radii = {0.01};
    fiber.names = {"fiber"};
    return fiber;
  }
};

}  // namespace node_test
