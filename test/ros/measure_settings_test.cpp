// What settings cost, measured by the running node beside its work.
#include <cmath>
#include <future>

#include "fiber_proximity/MeasureSettings.h"
#include "test/ros/messages.hpp"
#include "test/ros/node_test.hpp"
#include "test/support/random.hpp"

namespace {

using fiber_proximity::FiberArray;
using fiber_proximity::MeasureSettings;
using fiber_proximity::SettingMeasurement;
using node_test::call_service;
using test_messages::fiber_array;
using test_messages::header;

class MeasureSettingsTest : public node_test::NodeTest {
 protected:
  static MeasureSettings::Response call(double seconds, double noise = 0.0) {
    MeasureSettings call;
    call.request.seconds = seconds;
    call.request.noise = noise;
    EXPECT_TRUE(call_service("/proximity/measure_settings", call));
    return call.response;
  }

  /// Cables that wander about each other.
  static FiberArray cables(fiber::test::Random& random) {
    test_messages::Points points;
    FiberArray message;
    std::vector<std::uint32_t> offsets{0};
    for (int cable = 0; cable < 4; ++cable) {
      Eigen::Vector3d at(0.0, 0.05 * cable, 0.0);
      for (int i = 0; i < 30; ++i) {
        points.emplace_back(at);
        at += Eigen::Vector3d(0.02, random.uniform(-0.01, 0.01), random.uniform(-0.01, 0.01));
      }
      offsets.push_back(static_cast<std::uint32_t>(points.size()));
    }
    message = fiber_array(header("world"), points);
    message.offsets = offsets;
    message.radii = {0.002};
    return message;
  }
};

TEST_F(MeasureSettingsTest, ANodeWithoutFibersSaysSo) {
  const MeasureSettings::Response response = call(0.5);
  EXPECT_EQ(response.success, 0);
  EXPECT_EQ(response.message, "there are no fibres to measure with");
}

TEST_F(MeasureSettingsTest, ComparesSettingsWhileAnswersGoOn) {
  fiber::test::Random random(1);
  const ros::Publisher publisher = advertise<FiberArray>("fibers");
  connect(publisher, cables(random));
  std::future<MeasureSettings::Response> measuring =
      std::async(std::launch::async, [] { return call(3.0, 1e-3); });
  const std::size_t before = statistics.messages.size();
  ASSERT_TRUE(node_test::wait_for([&] {
    FiberArray message = cables(random);
    message.header.stamp = new_stamp();
    publisher.publish(message);
    ros::WallDuration(0.02).sleep();
    return measuring.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }));
  EXPECT_GT(statistics.messages.size(), before + 20) << "answers stopped meanwhile";
  const MeasureSettings::Response response = measuring.get();
  ASSERT_EQ(response.success, 1) << response.message;
  EXPECT_GT(response.frames, 5U) << "new frames came";
  EXPECT_EQ(response.questions, (std::vector<std::string>{"all", "closest"}));
  ASSERT_EQ(response.recommendations.size(), 2U);
  std::map<std::string, SettingMeasurement> closest;
  for (const SettingMeasurement& setting : response.settings) {
    EXPECT_GT(setting.answers, 0U) << setting.name;
    EXPECT_GT(setting.median_time, 0.0) << setting.name;
    EXPECT_LE(setting.median_time, setting.p99_time) << setting.name;
    EXPECT_EQ(setting.bounds_kept_percent, 100.0) << setting.name;
    if (setting.kind != "deadline") {
      EXPECT_EQ(setting.missed_percent, 0.0) << setting.name;
      EXPECT_EQ(setting.complete_percent, 100.0) << setting.name;
    }
    if (setting.question == "closest") {
      closest[setting.name] = setting;
    }
  }
  ASSERT_EQ(closest.count("exact"), 1U);
  EXPECT_EQ(closest["exact"].error, 0.0);
  EXPECT_LT(closest["robust"].error, 1e-12);
  ASSERT_EQ(closest.count("tolerance of 10 mm"), 1U);
  EXPECT_LE(closest["tolerance of 10 mm"].error, 0.01);
  EXPECT_NEAR(closest["tolerance of 10 mm"].doubt, 0.01, 0.01);
  for (const std::string& sentence : response.recommendations) {
    EXPECT_EQ(sentence.find("take "), 0U) << sentence;
  }
}

TEST_F(MeasureSettingsTest, BadRequestsAreRefused) {
  EXPECT_EQ(call(61.0).message,
            "seconds is 61.000000, it must be above 0 and at most 60, or 0 for 5");
  EXPECT_EQ(call(-1.0).success, 0);
  EXPECT_EQ(call(std::nan("")).success, 0);
  EXPECT_EQ(call(1.0, -1.0).message, "noise is -1.000000, it must be finite and at least 0");
}

}  // namespace
