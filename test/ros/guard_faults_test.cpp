// The example that guards a robot, beside a node whose sources fail: each fault of the table in
// docs/reliability.md stops it, and holds it as long as it lasts.
#include <std_msgs/Bool.h>
#include <std_srvs/Trigger.h>

#include "test/ros/unknown_sources.hpp"

namespace {

using namespace unknown_test;  // NOLINT(google-build-using-namespace)

class GuardFaultsTest : public FailingSources {
 protected:
  GuardFaultsTest() { start(); }

  static std_srvs::Trigger::Response reset() {
    std_srvs::Trigger service;
    EXPECT_TRUE(node_test::call_service("/guard/reset", service));
    return service.response;
  }

  bool is_stopped() const { return stops_.messages.empty() || stops_.messages.back()->data != 0; }

  /// Until the robot may go for a while: what was sent before a fault was mended may arrive later.
  void go() {
    std::string reason;
    int steps = 0;
    ASSERT_TRUE(node_test::wait_for([&] {
      step();
      const std_srvs::Trigger::Response answer = reset();
      reason = answer.message;
      steps = answer.success && !is_stopped() ? steps + 1 : 0;
      return steps == 10;
    })) << reason;
  }

  /// Until it stops for this source, and a while longer: it may not be reset.
  void expect_stop(const Source& source) {
    std::string reason;
    ASSERT_TRUE(node_test::wait_for([&] {
      step();
      if (is_stopped()) {
        reason = reset().message;
      }
      return reason.find(source.name + " since ") != std::string::npos;
    })) << reason;
    for (int i = 0; i < 5; ++i) {
      step();
      EXPECT_FALSE(reset().success) << "not for good";
      EXPECT_TRUE(is_stopped());
    }
  }

  node_test::Recorder<std_msgs::Bool> stops_{node, "/guard/stop"};
};

// First of its suite.
TEST_F(GuardFaultsTest, WhatNeverCameHoldsIt) {
  for (Source& source : sources_) {
    for (int i = 0; i < 5; ++i) {
      step();
      EXPECT_TRUE(is_stopped()) << "before " << source.name;
      EXPECT_FALSE(reset().success) << "before " << source.name;
    }
    source.fault = Fault::NONE;
  }
  go();
}

TEST_F(GuardFaultsTest, WhatFailsStopsItUntilItIsBack) {
  for (Source& source : sources_) {
    source.fault = Fault::NONE;
  }
  go();
  for (Source& source : sources_) {
    for (const Fault fault : source.faults) {
      SCOPED_TRACE(source.name + ", " + name_of(fault));
      source.fault = fault;
      expect_stop(source);
      source.fault = Fault::NONE;
      go();
    }
  }
}

}  // namespace
