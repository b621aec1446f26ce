// The demo's cables, by our engine and by FCL in the running node.
#include <dynamic_reconfigure/Reconfigure.h>

#include <limits>

#include "fiber_proximity/CompareWithFcl.h"
#include "fiber_proximity/Comparison.h"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::CompareWithFcl;
using fiber_proximity::Comparison;
using fiber_proximity::FclComparison;

class CompareTest : public node_test::NodeTest {
 protected:
  static CompareWithFcl::Response call() {
    CompareWithFcl call;
    EXPECT_TRUE(node_test::call_service("/proximity/compare", call));
    return call.response;
  }

  static void set_compare(bool on) {
    dynamic_reconfigure::Reconfigure call;
    call.request.config.bools.resize(1);
    call.request.config.bools[0].name = "compare";
    call.request.config.bools[0].value = on;
    EXPECT_TRUE(node_test::call_service("/proximity/set_parameters", call));
  }

  static void set_query(const std::string& type, double margin) {
    dynamic_reconfigure::Reconfigure call;
    call.request.config.strs.resize(1);
    call.request.config.strs[0].name = "query_type";
    call.request.config.strs[0].value = type;
    call.request.config.doubles.resize(1);
    call.request.config.doubles[0].name = "margin";
    call.request.config.doubles[0].value = margin;
    EXPECT_TRUE(node_test::call_service("/proximity/set_parameters", call));
  }

  static void expect_agreement(const Comparison& found) {
    EXPECT_EQ(found.engine, "run_tree");
    EXPECT_EQ(found.kernel, "robust");
    EXPECT_EQ(found.header.frame_id, "world");
    EXPECT_EQ(found.fiber_names.size(), 5U);
    EXPECT_GT(found.update_time, 0.0);
    EXPECT_GT(found.detect_time, 0.0);
    EXPECT_GE(found.pair_tests, found.contacts);
    EXPECT_TRUE(found.ours_is_right);
    ASSERT_EQ(found.fcl.size(), 2U);
    EXPECT_EQ(found.fcl[0].style, "user");
    EXPECT_EQ(found.fcl[1].style, "best");
    for (const FclComparison& fcl : found.fcl) {
      EXPECT_GT(fcl.update_time, 0.0);
      EXPECT_GT(fcl.detect_time, 0.0);
      EXPECT_EQ(fcl.contacts, found.contacts);
      EXPECT_EQ(fcl.in_both, found.contacts);
      EXPECT_EQ(fcl.only_ours + fcl.only_fcl + fcl.no_answer, 0U);
      EXPECT_TRUE(fcl.disagreements.empty());
    }
    EXPECT_LT(found.fcl[0].largest_difference, 1e-14);
    EXPECT_EQ(found.fcl[1].largest_difference, 0.0);
  }

  node_test::Recorder<Comparison> comparisons{node, "/proximity/comparison"};
};

TEST_F(CompareTest, ServesAComparisonOfTheNewestFibres) {
  ASSERT_NE(contacts.wait_for([](const auto& answer) { return !answer.fiber_names.empty(); }),
            nullptr);
  const CompareWithFcl::Response response = call();
  ASSERT_TRUE(response.success) << response.message;
  expect_agreement(response.comparison);
  EXPECT_EQ(response.comparison.margin, 0.004);
  const auto* answer = contacts.wait_for(response.comparison.header.stamp);
  ASSERT_NE(answer, nullptr);
  EXPECT_EQ(response.comparison.contacts, answer->contacts.size());
}

TEST_F(CompareTest, ComparesEveryMessageWhileItIsSwitchedOn) {
  ASSERT_TRUE(node_test::wait_for([&] { return contacts.messages.size() > 20; }));
  EXPECT_TRUE(comparisons.messages.empty()) << "it is off by default";
  set_compare(true);
  ASSERT_TRUE(node_test::wait_for([&] {
    return comparisons.messages.size() > 20 && !comparisons.messages.back()->fcl.empty();
  }));
  std::uint64_t most = 0;
  for (const auto& comparison : comparisons.messages) {
    expect_agreement(*comparison);
    const auto* answer = contacts.wait_for(comparison->header.stamp);
    ASSERT_NE(answer, nullptr);
    EXPECT_EQ(comparison->contacts, answer->contacts.size());
    most = std::max(most, comparison->contacts);
  }
  EXPECT_GT(most, 3U);
  set_compare(false);
  const std::size_t seen = contacts.messages.size();
  ASSERT_TRUE(node_test::wait_for([&] { return contacts.messages.size() > seen + 5; }));
  const std::size_t compared = comparisons.messages.size();
  ASSERT_TRUE(node_test::wait_for([&] { return contacts.messages.size() > seen + 20; }));
  EXPECT_EQ(comparisons.messages.size(), compared);
}

TEST_F(CompareTest, SaysWhyNot) {
  set_query("closest", std::numeric_limits<double>::infinity());
  const CompareWithFcl::Response response = call();
  set_query("all", 0.004);
  EXPECT_FALSE(response.success);
  EXPECT_NE(response.message.find("margin is infinite"), std::string::npos) << response.message;
  EXPECT_TRUE(response.comparison.fcl.empty());
}

}  // namespace
