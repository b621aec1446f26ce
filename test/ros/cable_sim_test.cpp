// The simulation's node through the real graph.
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include "fiber_proximity/AttachFiber.h"
#include "fiber_proximity/DetachFiber.h"
#include "fiber_proximity/StepSimulation.h"
#include "ros/node_test.hpp"

namespace {

using Eigen::Vector3d;

class CableSimTest : public ::testing::Test {
 protected:
  template <class Service>
  typename Service::Response call(const std::string& name,
                                  const typename Service::Request& request = {}) {
    Service service;
    service.request = request;
    EXPECT_TRUE(ros::service::waitForService("/cable_sim/" + name, ros::Duration(20.0)));
    EXPECT_TRUE(ros::service::call("/cable_sim/" + name, service)) << name;
    return service.response;
  }

  void pause(bool is_paused) {
    std_srvs::SetBool::Request request;
    request.data = static_cast<decltype(request.data)>(is_paused);
    EXPECT_TRUE(call<std_srvs::SetBool>("pause", request).success);
  }

  double step(std::uint32_t frames) {
    fiber_proximity::StepSimulation::Request request;
    request.frames = frames;
    const auto response = call<fiber_proximity::StepSimulation>("step", request);
    EXPECT_TRUE(response.success);
    return response.time;
  }

  /// Where the fibre is after so many frames.
  std::vector<Vector3d> points_after(std::uint32_t frames) {
    EXPECT_TRUE(node_test::wait_for([this] { return !fibers.messages.empty(); }));
    const auto seq = fibers.messages.back()->header.seq;
    step(frames);
    EXPECT_TRUE(
        node_test::wait_for([&] { return fibers.messages.back()->header.seq >= seq + frames; }));
    return node_test::to_assembly(*fibers.messages.back()).points();
  }

  ros::NodeHandle node;
  node_test::Recorder<fiber_proximity::FiberArray> fibers{node, "/cable_sim/fibers"};
};

TEST_F(CableSimTest, StepsWhenAskedAndStartsAgainTheSame) {
  pause(true);
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  const std::vector<Vector3d> first = points_after(30);
  EXPECT_NEAR(step(0), 0.5, 1e-9);
  const std::vector<Vector3d> later = points_after(30);
  EXPECT_GT((later[30] - first[30]).norm(), 1e-3);
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  EXPECT_EQ(step(0), 0.0);
  EXPECT_EQ(points_after(30), first);
}

TEST_F(CableSimTest, MessagesAreWhatATrackerWouldSend) {
  points_after(1);
  const fiber_proximity::FiberArray& message = *fibers.messages.back();
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.names, std::vector<std::string>{"cable"});
  EXPECT_EQ(message.points.size(), 61U);
  EXPECT_EQ(message.radii, std::vector<double>{0.004});
}

TEST_F(CableSimTest, RunsInRealTimeUntilItIsPaused) {
  pause(false);
  const double begin = step(0);
  const ros::SteadyTime start = ros::SteadyTime::now();
  EXPECT_TRUE(node_test::wait_for([&] { return (ros::SteadyTime::now() - start).toSec() > 1.0; }));
  pause(true);
  const double end = step(0);
  // It may fall behind on a busy machine, but never run ahead.
  EXPECT_GT(end, begin);
  EXPECT_LT(end - begin, (ros::SteadyTime::now() - start).toSec() + 0.1);
  EXPECT_EQ(step(0), end);
}

TEST_F(CableSimTest, TakesHoldOfNodesAndLetsGo) {
  pause(true);
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  fiber_proximity::AttachFiber::Request request;
  request.fiber = "cable";
  request.node = 30;
  request.position.z = 0.9;
  request.speed = 1.0;
  const double start = points_after(1)[30].z();
  ASSERT_TRUE(call<fiber_proximity::AttachFiber>("attach", request).success);
  const double way = (Vector3d(0.0, 0.0, 0.9) - points_after(1)[30]).norm();
  const auto frames = static_cast<std::uint32_t>(std::ceil(60.0 * way)) + 2;
  EXPECT_NEAR((points_after(frames)[30] - Vector3d(0.0, 0.0, 0.9)).norm(), 0.0, 1e-9);
  EXPECT_LT(start, 0.8);

  fiber_proximity::DetachFiber::Request release;
  release.fiber = "cable";
  release.node = -31;  // the same
  ASSERT_TRUE(call<fiber_proximity::DetachFiber>("detach", release).success);
  EXPECT_LT(points_after(20)[30].z(), 0.89);
  const auto again = call<fiber_proximity::DetachFiber>("detach", release);
  EXPECT_FALSE(again.success);
  EXPECT_EQ(again.message, "nothing holds node -31 of fibre 'cable'");
}

TEST_F(CableSimTest, RefusesWhatIsNotThere) {
  fiber_proximity::AttachFiber::Request request;
  request.fiber = "rope";
  EXPECT_EQ(call<fiber_proximity::AttachFiber>("attach", request).message,
            "there is no fibre 'rope'");
  request.fiber = "cable";
  request.node = 61;
  EXPECT_EQ(call<fiber_proximity::AttachFiber>("attach", request).message,
            "fibre 'cable' has 61 nodes, there is no node 61");
  request.node = 0;
  request.position.x = std::nan("");
  EXPECT_EQ(call<fiber_proximity::AttachFiber>("attach", request).message,
            "position must be finite and speed at least 0");
}

}  // namespace
