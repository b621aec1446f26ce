#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace bridge_test {

/// For each object by its name, how far its shapes are from the origin [m], ascending.
using Distances = std::map<std::string, std::vector<double>>;

/// What /proximity knows of what a bridge has brought in.
class BridgeTest : public node_test::NodeTest {
 protected:
  /// Queries need a fibre to be there.
  void SetUp() override {
    publisher_ = advertise<fiber_proximity::FiberArray>("fibers");
    connect(publisher_, fiber());
  }

  /// Along z, at x = 0.5.
  static fiber_proximity::FiberArray fiber() {
    fiber_proximity::FiberArray message =
        test_messages::fiber_array(test_messages::header("world"), {{0.5, 0, -1}, {0.5, 0, 1}});
    message.radii = {0.01};
    return message;
  }

  static Distances distances() {
    using fiber_proximity::QueryProximity;
    QueryProximity query;
    query.request.against = QueryProximity::Request::ENVIRONMENT;
    query.request.type = QueryProximity::Request::ALL;
    query.request.margin = std::numeric_limits<double>::infinity();
    query.request.shapes.resize(1);
    query.request.shapes[0].points.resize(1);
    EXPECT_TRUE(node_test::call_service("/proximity/query", query));
    EXPECT_TRUE(query.response.success) << query.response.message;
    Distances found;
    for (const fiber_proximity::Contact& contact : query.response.contacts) {
      found[query.response.object_names.at(contact.fiber_b)].push_back(contact.distance);
    }
    for (auto& [name, of_shapes] : found) {
      std::sort(of_shapes.begin(), of_shapes.end());
    }
    return found;
  }

  /// Waits until the node answers so; distances are as in the closed form, but for rounding.
  static void expect_distances(const Distances& expected) {
    const auto is_expected = [&] {
      const Distances found = distances();
      return std::equal(
          found.begin(), found.end(), expected.begin(), expected.end(),
          [](const auto& a, const auto& b) {
            return a.first == b.first &&
                   std::equal(a.second.begin(), a.second.end(), b.second.begin(), b.second.end(),
                              [](double x, double y) { return std::abs(x - y) < 1e-6; });
          });
    };
    EXPECT_TRUE(node_test::wait_for(is_expected)) << ::testing::PrintToString(distances());
  }

  ros::Publisher publisher_;
};

}  // namespace bridge_test
