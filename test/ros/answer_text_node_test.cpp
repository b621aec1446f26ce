// What the running node's text says of its answers, and how a deadline binds them.
#include <diagnostic_msgs/DiagnosticArray.h>

#include <map>

#include "fiber_proximity/TimeToContact.h"
#include "test/ros/answer_claims.hpp"
#include "test/ros/answer_text_fixture.hpp"

namespace {

using answer_claims::claims_of;
using fiber_proximity::ProximityConfig;
using fiber_proximity::Statistics;
using fiber_proximity::TimeToContact;
using node_test::AnswerTextTest;
using node_test::set_parameters;

TEST_F(AnswerTextTest, OfAnInputThatHasNotComeYetNothingIsToldAsComplete) {
  ProximityConfig config = shown();
  config.margin = 0.1;
  set_parameters(config);
  std::vector<std::string> lines = lines_about(cables());
  EXPECT_EQ(lines[0].rfind("robust: at least 1 contacts (each to ", 0), 0U) << lines[0];
  EXPECT_NE(lines[0].find(", of what is known, closest known 27.7 mm, true may be closer"),
            std::string::npos)
      << lines[0];
  EXPECT_NE(lines[1].find(", of what is known"), std::string::npos) << lines[1];
  send_rope();
  set_parameters(config);
  lines = lines_about(cables());
  EXPECT_EQ(lines[0].rfind("robust: 1 of 1 contacts (each to ", 0), 0U) << lines[0];
  EXPECT_NE(lines[0].find("closest 27.7 mm (to "), std::string::npos) << lines[0];
  EXPECT_EQ(lines[1].rfind("objects: ", 0), 0U) << lines[1];
}

TEST_F(AnswerTextTest, ToleranceAndDeadlineAreInTheTextAtOnce) {
  send_rope();
  ProximityConfig config = shown();
  config.query_type = "closest";
  config.margin = 1.0;
  config.tolerance = 0.02;
  set_parameters(config);
  std::vector<std::string> lines = lines_about(cables());
  const Statistics* told = statistics.wait_for(stamp_);
  ASSERT_GT(told->minimum_upper - told->minimum_lower, 0.01) << "nothing is given up";
  EXPECT_EQ(lines[0].rfind("robust: closest 27.7 mm, true >= 7.", 0), 0U) << lines[0];
  EXPECT_LE(claims_of(lines[0]).minimum_lower, told->minimum_lower);
  EXPECT_NEAR(claims_of(lines[0]).minimum_lower, told->minimum_lower, 1e-4);

  config.query_type = "all";
  config.tolerance = 0.0;
  config.deadline = 1e-9;
  set_parameters(config);
  lines = lines_about(cables());
  EXPECT_EQ(lines[0].rfind("robust: at least ", 0), 0U) << lines[0];
  EXPECT_NE(lines[0].find(", cut off"), std::string::npos) << lines[0];
  EXPECT_NE(lines[2].find("contacts 0.0"), std::string::npos) << lines[2];
  EXPECT_NE(lines[2].find("(incomplete)"), std::string::npos) << lines[2];
}

TEST_F(AnswerTextTest, ADeadlineIsOneForAllPartsAndEachTellsWhetherItIsComplete) {
  send_rope();
  const node_test::Recorder<fiber_proximity::ContactArray> around(
      node, "/proximity/environment_contacts");
  const node_test::Recorder<TimeToContact> times(node, "/proximity/time_to_contact");
  const node_test::Recorder<diagnostic_msgs::DiagnosticArray> diagnostics(node, "/diagnostics");
  ASSERT_TRUE(around.wait_for_connection() && times.wait_for_connection() &&
              diagnostics.wait_for_connection());
  ProximityConfig config = shown();
  config.margin = 0.1;
  config.continuous = true;
  config.prediction = 0.5;
  for (const double deadline : {1e-9, 1000.0}) {
    const bool is_enough = deadline > 1.0;
    SCOPED_TRACE(deadline);
    config.deadline = deadline;
    set_parameters(config);
    lines_about(cables());
    lines_about(cables());
    const std::vector<std::string> lines = lines_about(cables());
    const Statistics* const told = statistics.wait_for(stamp_);
    std::map<std::string, bool> is_complete;
    for (std::size_t i = 0; i < told->parts.size(); ++i) {
      is_complete[told->parts[i]] = told->part_complete[i] != 0;
    }
    for (const char* part : {"contacts", "minimum", "motion", "environment_motion", "prediction"}) {
      ASSERT_EQ(is_complete.count(part), 1U) << part;
      EXPECT_EQ(is_complete[part], is_enough) << part;
    }
    EXPECT_TRUE(is_complete["merge"] && is_complete["update"]);
    EXPECT_EQ(told->complete != 0, is_enough);
    EXPECT_EQ(lines[2].find("updates alone take longer") == std::string::npos, is_enough);
    EXPECT_NE(lines[2].find(is_enough ? " of 1000000.00 ms: " : " of 0.00 ms: "), std::string::npos)
        << lines[2];
    const TimeToContact* const ahead = times.wait_for(stamp_);
    ASSERT_NE(ahead, nullptr);
    EXPECT_EQ(ahead->complete != 0, is_enough);
    EXPECT_EQ(ahead->problem, is_enough ? "" : "the deadline of 1e-09 s leaves no time for it");
    const fiber_proximity::ContactArray* const found = contacts.wait_for(stamp_);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->continuous != 0, is_enough);
    EXPECT_EQ(found->complete != 0, is_enough);
  }
  EXPECT_NE(diagnostics.wait_for([](const diagnostic_msgs::DiagnosticArray& message) {
    return std::any_of(message.status.begin(), message.status.end(), [](const auto& status) {
      return status.level == diagnostic_msgs::DiagnosticStatus::WARN &&
             status.message.find("updates alone took longer than the deadline") !=
                 std::string::npos;
    });
  }),
            nullptr);
}

}  // namespace
