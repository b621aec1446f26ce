// Simulated time that an earlier launch has left: whoever waits for it says so.
#include <set>

#include "test/ros/node_test.hpp"

namespace {

using NoClockTest = node_test::NodeTest;

TEST_F(NoClockTest, EachNodeSaysThatTimeStandsStill) {
  const std::set<std::string> all{"/cable_sim", "/fiber_player", "/play_tracker", "/proximity"};
  std::set<std::string> told;
  EXPECT_TRUE(node_test::wait_for([&] {
    for (const auto& log : logs.messages) {
      if (log->level == rosgraph_msgs::Log::WARN &&
          log->msg.rfind("time stands still: the parameter /use_sim_time is true", 0) == 0) {
        told.insert(log->name);
      }
    }
    return told == all;
  })) << "only "
      << told.size() << " of " << all.size();
}

}  // namespace
