// The parameters that change while the node runs.
#include <limits>

#include "test/ros/live_settings.hpp"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"

namespace {

using fiber_proximity::ContactArray;
using fiber_proximity::FiberArray;
using fiber_proximity::ProximityConfig;

class ReconfigureTest : public node_test::NodeTest {
 protected:
  void SetUp() override {
    publisher_ = advertise<FiberArray>("fibers");
    connect(publisher_, fibers_message());
  }

  /// Ten straight fibres side by side, 0.1 m apart, 0.09 m between their surfaces.
  static FiberArray fibers_message() {
    test_messages::Points points;
    for (int i = 0; i < 10; ++i) {
      points.emplace_back(0.0, 0.1 * i, 0.0);
      points.emplace_back(1.0, 0.1 * i, 0.0);
    }
    FiberArray message = test_messages::fiber_array(test_messages::header("map"), points);
    message.offsets = {0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20};
    return message;
  }

  static ProximityConfig set(const ProximityConfig& config) {
    return node_test::set_parameters(config);
  }

  /// The answer about fibres sent now.
  ContactArray answer() {
    FiberArray message = fibers_message();
    message.header.stamp = new_stamp();
    publisher_.publish(message);
    const ContactArray* found = contacts.wait_for(message.header.stamp);
    EXPECT_NE(found, nullptr);
    return found == nullptr ? ContactArray() : *found;
  }

  fiber_proximity::Statistics statistics_of(const ContactArray& answer) {
    const fiber_proximity::Statistics* found = statistics.wait_for(answer.header.stamp);
    EXPECT_NE(found, nullptr);
    return found == nullptr ? fiber_proximity::Statistics() : *found;
  }

  ros::Publisher publisher_;
};

TEST_F(ReconfigureTest, TheNextAnswerFollowsTheParameters) {
  ContactArray now = answer();
  EXPECT_EQ(now.margin, 0.25);
  EXPECT_EQ(now.contacts.size(), 9U + 8U);  // neighbours, and neighbours of neighbours

  ProximityConfig config = ProximityConfig::__getDefault__();
  config.margin = 0.1;
  set(config);
  now = answer();
  EXPECT_EQ(now.margin, 0.1);
  EXPECT_EQ(now.contacts.size(), 9U);
  EXPECT_FALSE(now.limit_reached);

  config.query_type = "limited";
  config.max_contacts = 4;
  set(config);
  now = answer();
  EXPECT_EQ(now.contacts.size(), 4U);
  EXPECT_TRUE(now.limit_reached);

  config.query_type = "fiber_pairs";
  config.margin = 0.2;
  set(config);
  now = answer();
  EXPECT_EQ(now.contacts.size(), 9U + 8U) << "one segment per fibre";
  EXPECT_FALSE(now.limit_reached);

  config.query_type = "closest";
  config.margin = 0.0;
  set(config);
  now = answer();
  EXPECT_TRUE(now.contacts.empty());
  EXPECT_TRUE(now.has_minimum);
  EXPECT_NEAR(now.minimum_distance, 0.09, 1e-12);
}

TEST_F(ReconfigureTest, AccuracyCanBeChosenWhileItRuns) {
  ProximityConfig config = ProximityConfig::__getDefault__();
  config.margin = 0.1;
  config.kernel = "exact";
  config.tolerance = 0.001;
  set(config);
  ContactArray now = answer();
  EXPECT_EQ(now.kernel, "exact");
  EXPECT_EQ(now.tolerance, 0.001);
  EXPECT_TRUE(now.complete);
  EXPECT_LE(now.minimum_lower, now.minimum_distance);
  EXPECT_LE(now.minimum_distance, now.minimum_upper);

  config.accuracy = "robust";
  set(config);
  now = answer();
  EXPECT_EQ(now.kernel, "robust");
  EXPECT_EQ(now.tolerance, 0.0);
  expect_log(
      "parameter /proximity/accuracy is robust, which overrides kernel exact, "
      "tolerance 0.001; accuracy custom uses them");
  EXPECT_EQ(now.contacts.size(), 9U);
  EXPECT_LT(statistics_of(now).contact_error, 1e-15);

  config.accuracy = "deadline";
  config.deadline = 1e-9;
  set(config);
  now = answer();
  EXPECT_FALSE(now.complete);
  EXPECT_FALSE(statistics_of(now).complete);
  EXPECT_LT(now.minimum_lower, 0.0);
  config.deadline = 1000.0;
  set(config);
  now = answer();
  EXPECT_TRUE(now.complete);
  EXPECT_EQ(now.contacts.size(), 9U);
}

/// Sets one parameter alone, as `dynparam set` does.
void set_one(const std::string& name, const std::string& value) {
  dynamic_reconfigure::Reconfigure call;
  call.request.config.strs.resize(1);
  call.request.config.strs[0].name = name;
  call.request.config.strs[0].value = value;
  ASSERT_TRUE(node_test::call_service("/proximity/set_parameters", call));
}
void set_one(const std::string& name, double value) {
  dynamic_reconfigure::Reconfigure call;
  call.request.config.doubles.resize(1);
  call.request.config.doubles[0].name = name;
  call.request.config.doubles[0].value = value;
  ASSERT_TRUE(node_test::call_service("/proximity/set_parameters", call));
}

TEST_F(ReconfigureTest, WhatAccuracyOverridesIsToldOnceInAnyOrder) {
  const std::string accuracy = "parameter /proximity/accuracy is ";
  set(ProximityConfig::__getDefault__());
  set_one("accuracy", "exact");
  set_one("deadline", 0.002);
  expect_log(accuracy + "exact, which overrides deadline 0.002; accuracy custom uses them");
  set_one("tolerance", 0.125);
  expect_log(accuracy +
             "exact, which overrides tolerance 0.125, deadline 0.002; accuracy custom uses them");
  set_one("kernel", "robust");  // the default, and yet somebody wants it
  expect_log(accuracy + "exact, which overrides kernel robust, tolerance 0.125, deadline 0.002");
  set_one("margin", 0.1);
  set_one("margin", 0.2);
  EXPECT_EQ(answer().kernel, "exact");
  EXPECT_EQ(logs_of(accuracy + "exact, which overrides kernel robust").size(), 1U);
  EXPECT_EQ(logs_of(accuracy + "exact").size(), 3U);

  set(ProximityConfig::__getDefault__());
  set_one("relative_tolerance", 0.25);
  set_one("kernel", "exact");
  set_one("accuracy", "robust");
  expect_log(accuracy + "robust, which overrides kernel exact, relative_tolerance 0.25");
}

TEST_F(ReconfigureTest, TheAccuracyOfADeadlineWaitsForOne) {
  const std::string waits =
      "parameter /proximity/accuracy is deadline, which has no effect until deadline is above 0 s";
  ProximityConfig config = ProximityConfig::__getDefault__();
  config.tolerance = 0.125;
  set(config);
  set_one("accuracy", "deadline");
  expect_log(waits);
  EXPECT_EQ(answer().tolerance, 0.125);
  set_one("deadline", 1000.0);
  expect_log(
      "parameter /proximity/accuracy is deadline, which overrides tolerance 0.125; accuracy "
      "custom uses them");
  EXPECT_EQ(answer().tolerance, 0.0);
  set_one("deadline", 0.0);
  EXPECT_TRUE(node_test::wait_for([&] { return logs_of(waits).size() == 2U; })) << "again";
  EXPECT_EQ(answer().tolerance, 0.125);
  set(ProximityConfig::__getDefault__());
}

TEST_F(ReconfigureTest, AnAccuracyThatCannotBeIsAnError) {
  set(ProximityConfig::__getDefault__());
  ProximityConfig bad = ProximityConfig::__getDefault__();
  bad.accuracy = "sloppy";
  EXPECT_EQ(set(bad).accuracy, "custom");
  expect_log(
      "parameter /proximity/accuracy is sloppy, it must be one of custom, robust, "
      "exact, deadline");
  bad = ProximityConfig::__getDefault__();
  bad.kernel = "double";
  EXPECT_EQ(set(bad).kernel, "robust");
  expect_log("parameter /proximity/kernel is double, it must be one of robust, exact");
}

TEST_F(ReconfigureTest, BadValuesAreAnErrorAndChangeNothing) {
  ProximityConfig good = ProximityConfig::__getDefault__();
  good.margin = 0.1;
  set(good);
  ProximityConfig bad = good;
  bad.query_type = "nearest";
  bad.margin = 0.25;
  ProximityConfig in_use = set(bad);
  EXPECT_EQ(in_use.query_type, "all");
  EXPECT_EQ(in_use.margin, 0.1);
  expect_log(
      "parameters stay as they were: parameter /proximity/query_type is nearest, it must "
      "be one of first, closest, limited, all, fiber_pairs");

  bad = good;
  bad.margin = std::numeric_limits<double>::quiet_NaN();
  in_use = set(bad);
  EXPECT_EQ(in_use.margin, 0.1);
  expect_log(
      "parameters stay as they were: parameter /proximity/margin is nan, it must be a "
      "number of at least 0");
  EXPECT_EQ(answer().contacts.size(), 9U);

  bad = good;
  bad.max_contacts = -1;
  EXPECT_EQ(set(bad).max_contacts, good.max_contacts);
  expect_log(
      "parameters stay as they were: parameter /proximity/max_contacts is -1, it must be "
      "a whole number of at least 1");
  int on_server = 0;
  EXPECT_TRUE(ros::param::get("/proximity/max_contacts", on_server));
  EXPECT_EQ(on_server, good.max_contacts);
}

TEST_F(ReconfigureTest, ValuesOfAnotherTypeOrNameChangeNothing) {
  set(ProximityConfig::__getDefault__());
  dynamic_reconfigure::Reconfigure call;
  call.request.config.ints.resize(1);
  call.request.config.ints[0].name = "show_boxes";
  call.request.config.ints[0].value = 1;
  call.request.config.doubles.resize(1);
  call.request.config.doubles[0].name = "margin";
  call.request.config.doubles[0].value = 0.1;
  ASSERT_TRUE(node_test::call_service("/proximity/set_parameters", call));
  ProximityConfig in_use;
  ASSERT_TRUE(in_use.__fromMessage__(call.response.config));
  EXPECT_EQ(in_use.margin, 0.0) << "all of a request, or nothing";
  expect_log(
      "parameters stay as they were: parameter show_boxes is a value of type int, it "
      "must be true or false");
  call.request.config = {};
  call.request.config.doubles.resize(1);
  call.request.config.doubles[0].name = "margn";
  ASSERT_TRUE(node_test::call_service("/proximity/set_parameters", call));
  expect_log("parameters stay as they were: there is no parameter margn");
}

}  // namespace
