// The service ~query of the running node: accuracy, deadline and what is refused.
#include <functional>
#include <limits>

#include "test/ros/query_fixture.hpp"
#include "test/support/answers.hpp"
#include "test/support/not_finite.hpp"

namespace {

using fiber::test::nan;
using fiber_proximity::QueryProximity;
using node_test::QueryTest;
using test_messages::Points;

TEST_F(QueryTest, AccuracyIsChosenByCall) {
  send_fibers();
  const Points line{{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}};
  const fiber::FiberAssembly asked(line, {0, 3}, {0.1});
  fiber::QueryOptions options;
  options.type = fiber::QueryType::CLOSEST;
  options.margin = std::numeric_limits<double>::infinity();
  const fiber::QueryResult truth = fiber::test::brute_force(asked, assembly_, options);
  const double minimum = truth.contacts.front().distance;
  QueryProximity::Request request;
  request.margin = options.margin;
  request.shapes = {shape("world", line, 0.1)};
  request.type = QueryProximity::Request::CLOSEST;
  for (const char* kernel : {"", "robust", "exact"}) {
    for (const double tolerance : {0.0, 0.05, 10.0}) {
      request.kernel = kernel;
      request.tolerance = tolerance;
      const QueryProximity::Response response = call(request);
      ASSERT_TRUE(response.success) << response.message;
      EXPECT_TRUE(response.complete);
      ASSERT_EQ(response.contacts.size(), 1U);
      const fiber_proximity::Contact& contact = response.contacts.front();
      EXPECT_LE(contact.lower, contact.distance);
      EXPECT_LE(contact.distance, contact.upper);
      EXPECT_LE(contact.distance, minimum + tolerance + 1e-12);
      ASSERT_EQ(response.minimum_lower.size(), 1U);
      EXPECT_LE(response.minimum_lower.front(), minimum + 1e-15);
      EXPECT_GE(response.minimum_lower.front(), contact.distance - tolerance - 1e-12);
    }
  }
  request.tolerance = 0.0;
  request.kernel = "exact";
  // The surfaces' distance, but for its last digits: the kernels know better than brute force.
  EXPECT_NEAR(call(request).contacts.front().distance, minimum, 1e-15);
}

TEST_F(QueryTest, ADeadlineCutsTheAnswerOffAndSaysSo) {
  send_fibers();
  QueryProximity::Request request;
  request.type = QueryProximity::Request::ALL;
  request.margin = std::numeric_limits<double>::infinity();
  request.shapes = {shape("world", {{-1, 0, 0}, {1, 0, 0}}, 0.1),
                    shape("world", {{0, -1, 0}, {0, 1, 0}}, 0.1)};
  request.deadline = 1e-9;
  const QueryProximity::Response cut = call(request);
  ASSERT_TRUE(cut.success) << cut.message;
  EXPECT_FALSE(cut.complete);
  EXPECT_EQ(cut.offsets.size(), 3U);
  EXPECT_EQ(cut.minimum_lower.size(), 2U);
  for (const double lower : cut.minimum_lower) {
    EXPECT_LT(lower, 0.0) << "no more is known than how thick they are";
  }
  request.deadline = 1000.0;
  const QueryProximity::Response whole = call(request);
  EXPECT_TRUE(whole.complete);
  EXPECT_EQ(whole.contacts.size(), 2U * assembly_.segment_count());
}

TEST_F(QueryTest, BadRequestsAreAnsweredWithTheReason) {
  send_fibers();
  QueryProximity::Request good;
  good.type = QueryProximity::Request::ALL;
  good.margin = 0.5;
  good.shapes = {shape("world", {{0, 0, 0}}, 0.1), shape("world", {{0, 0, 0}, {1, 0, 0}}, 0.1)};
  const auto expect_error = [&](const std::function<void(QueryProximity::Request&)>& change,
                                const std::string& message) {
    QueryProximity::Request request = good;
    change(request);
    const QueryProximity::Response response = call(request);
    EXPECT_FALSE(response.success);
    EXPECT_EQ(response.message.substr(0, message.size()), message);
    EXPECT_TRUE(response.contacts.empty());
    EXPECT_TRUE(response.offsets.empty());
    EXPECT_TRUE(call(good).success) << "the node does not live on";
  };
  expect_error(
      [](auto& request) { request.type = 7; },
      "type is 7, it must be 0 (FIRST), 1 (CLOSEST), 2 (LIMITED), 3 (ALL) or 4 (FIBER_PAIRS)");
  expect_error([](auto& request) { request.type = 5; }, "type is 5, it must be 0 (FIRST)");
  expect_error([](auto& request) { request.margin = -0.25; }, "margin is -0.25");
  expect_error([](auto& request) { request.margin = nan; }, "margin is nan");
  expect_error([](auto& request) { request.type = QueryProximity::Request::LIMITED; },
               "max_contacts is 0");
  expect_error([](auto& request) { request.kernel = "double"; },
               "unknown kernel 'double', known are: robust, exact");
  expect_error([](auto& request) { request.tolerance = -1.0; },
               "tolerance is -1.000000, it must be finite and at least 0 m");
  expect_error([](auto& request) { request.relative_tolerance = nan; },
               "relative_tolerance is nan, it must be finite and at least 0");
  expect_error([](auto& request) { request.deadline = -1.0; },
               "deadline is -1.000000, it must be finite and at least 0 s (0 for none)");
  expect_error([](auto& request) { request.shapes[1].points.clear(); },
               "shape 1: has no points, it needs at least 1");
  expect_error([](auto& request) { request.shapes[1].points[1].z = nan; },
               "shape 1: fibre 0, point 1: z is nan");
  expect_error([](auto& request) { request.shapes[0].radius = -1.0; }, "shape 0: the radius is -1");
  expect_error([](auto& request) { request.shapes[1].radius = nan; }, "shape 1: the radius is nan");
  expect_error([](auto& request) { request.shapes[1].header.frame_id = "nowhere"; },
               "shape 1: no transform from frame 'nowhere' to 'world': unknown frame: ");
}

}  // namespace
