// What nobody should ask of the simulation's node, through the real graph.
#include <visualization_msgs/InteractiveMarkerFeedback.h>

#include <cmath>
#include <future>
#include <limits>

#include "test/ros/cable_sim_fixture.hpp"
#include "test/support/not_finite.hpp"

namespace {

using Eigen::Vector3d;
using fiber_proximity::AttachFiber;
using fiber_proximity::DetachFiber;
using fiber_proximity::SetSimulationParameters;
using fiber_proximity::StepSimulation;

using fiber::test::infinity;
using fiber::test::nan;

class CableSimLimitsTest : public CableSimTest {
 protected:
  void SetUp() override {
    pause(true);
    reset();
  }

  AttachFiber::Response attach(std::int32_t index, const Vector3d& position, double speed,
                               const std::string& fiber = "cable") {
    AttachFiber::Request request;
    request.fiber = fiber;
    request.node = index;
    request.position.x = position.x();
    request.position.y = position.y();
    request.position.z = position.z();
    request.speed = speed;
    return call<AttachFiber>("attach", request);
  }

  SetSimulationParameters::Response set(const std::string& name, const std::vector<double>& value) {
    SetSimulationParameters::Request request;
    request.parameters.emplace_back();
    request.parameters.back().name = name;
    request.parameters.back().value = value;
    return call<SetSimulationParameters>("set_parameters", request);
  }

  StepSimulation::Response try_step(std::uint32_t frames) {
    StepSimulation::Request request;
    request.frames = frames;
    return call<StepSimulation>("step", request);
  }

  /// An answer that says why not, and no more than one can read.
  template <class Response>
  static void expect_refused(const Response& response, const std::string& why) {
    EXPECT_FALSE(response.success) << why;
    EXPECT_NE(response.message.find(why), std::string::npos) << response.message;
    EXPECT_FALSE(response.message.empty());
    EXPECT_LT(response.message.size(), 600U);
  }

  /// The largest stretch of an edge, in parts of its 20 mm.
  static double strain_of(const std::vector<Vector3d>& points) {
    double largest = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      largest = std::max(largest, (points[i] - points[i - 1]).norm() / 0.02 - 1.0);
    }
    return largest;
  }
};

TEST_F(CableSimLimitsTest, AttachRefusesWhatTheFibreDoesNotReach) {
  for (const double x : {1e308, 1e200, 1e149, -1e10}) {
    expect_refused(attach(30, {x, 0, 1}, 1.0), "must be finite and at most 1.2e+09 m");
    expect_refused(attach(30, {0, 0, x}, 0.0), "must be finite and at most 1.2e+09 m");
  }
  for (const double speed : {0.0, 1.0, 100.0}) {
    expect_refused(attach(30, {0, 0, 100}, speed), "position (0, 0, 100) is 99");
    expect_refused(attach(30, {0, 0, 100}, speed),
                   "m from where node 0 of fibre 'cable' is held, with 0.6 m of it between: it "
                   "reaches 0.66 m, stretched by 10 % (max_strain)");
  }
  // The end that holds it may go as far as the other one lets it.
  expect_refused(attach(-1, {0.93, 0, 1}, 1.0), "is 1.33 m from where node 0");
  EXPECT_TRUE(attach(-1, {0.91, 0, 1}, 1.0).success);
  EXPECT_LT(strain_of(points_after(120)), 0.11);
  // Nothing has happened to what held it before a refusal.
  const Vector3d end = points_after(1)[60];
  // A hold is a spring, a thousand times as stiff as the fibre's edges, which are stretched by 9 %.
  EXPECT_NEAR((end - Vector3d(0.91, 0, 1)).norm(), 0.0, 2e-4 * 0.02);
  expect_refused(attach(-1, {100, 0, 1}, 1.0), "is 100 m from where node 0");
  EXPECT_EQ(points_after(1)[60], end);
}

TEST_F(CableSimLimitsTest, AttachRefusesSpeedsThatTear) {
  // Sound in it is sqrt(E / density) = 2132 m/s.
  expect_refused(attach(30, {0, 0, 0.9}, infinity), "may be moved at up to 213 m/s");
  expect_refused(attach(30, {0, 0, 0.9}, 1e9), "speed is 1e+09 m/s; fibre 'cable' may be moved");
  expect_refused(attach(30, {0, 0, 0.9}, -1.0), "position must be finite and speed at least 0");
  expect_refused(attach(30, {0, 0, 0.9}, nan), "position must be finite and speed");
  DetachFiber::Request release;
  release.fiber = "cable";
  for (const int end : {0, -1}) {
    release.node = end;
    EXPECT_TRUE(call<DetachFiber>("detach", release).success);
  }
  // Now nothing else holds it: it may be brought anywhere, but not at once.
  expect_refused(attach(30, {0, 0, 100}, 0.0), "which is at once: ");
  EXPECT_TRUE(attach(30, {0, 0, 100}, 10.0).success);
  for (int i = 0; i < 20; ++i) {
    EXPECT_LT(strain_of(points_after(3)), 0.1);
  }
}

TEST_F(CableSimLimitsTest, BadRequestsAreAnswered) {
  const std::string long_name(100000, 'x');
  for (const std::string& name : {std::string(), std::string("rope"), long_name}) {
    expect_refused(attach(0, {0, 0, 1}, 1.0, name), "there is no fibre '");
    DetachFiber::Request detach;
    detach.fiber = name;
    expect_refused(call<DetachFiber>("detach", detach), "there is no fibre '");
    expect_refused(set(name, {1.0}), name.size() > 500 ? "xxx" : "there is no such parameter");
  }
  for (const std::int32_t index :
       {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min(), 61}) {
    expect_refused(attach(index, {0, 0, 1}, 1.0), "there is no node");
    DetachFiber::Request detach;
    detach.fiber = "cable";
    detach.node = index;
    expect_refused(call<DetachFiber>("detach", detach), "there is no node");
  }
  for (const double number : {nan, infinity, -infinity}) {
    expect_refused(attach(0, {number, 0, 1}, 1.0), "position must be finite");
    expect_refused(attach(0, {0, 0, 1}, -std::abs(number)), "");
  }
  for (const double number : {nan, infinity, -infinity, 1e308, -1e7}) {
    expect_refused(set("gravity.acceleration", {0, 0, number}), "at most 1e6 in magnitude");
    expect_refused(set("damping.relaxation_time", {number}), "at most 1e6 in magnitude");
  }
  expect_refused(set("gravity.acceleration", {}), "a list of 3");
  expect_refused(set("gravity.acceleration", std::vector<double>(100000, 1e300)), "a list of 3");
  expect_refused(set("gravity.", {1}), "there is no such parameter");
  expect_refused(set(".", {1}), "there is no such parameter");
  EXPECT_EQ(points_after(1).size(), 61U);
  EXPECT_LT(strain_of(points_after(1)), 0.01);
}

/// Other services are served between the frames of a long ~step, and end it.
TEST_F(CableSimLimitsTest, ALongStepBlocksNothing) {
  for (const std::uint32_t frames : {1000001U, 4294967295U}) {
    expect_refused(try_step(frames),
                   "frames is " + std::to_string(frames) + ", it must be at most 1000000");
  }
  const auto step_in_background = [this] {
    const ros::Time asked = ros::Time::now();
    auto answer = std::async(std::launch::async, [] {
      StepSimulation service;
      service.request.frames = 1000000;
      node_test::call_service_alone("/cable_sim/step", service);
      return service.response;
    });
    // Messages of a step before may still be on their way.
    EXPECT_TRUE(node_test::wait_for(
        [&] { return !fibers.messages.empty() && fibers.messages.back()->header.stamp > asked; }));
    return answer;
  };
  auto step = step_in_background();
  EXPECT_TRUE(call<SetSimulationParameters>("set_parameters").success);
  EXPECT_TRUE(attach(30, {0, 0, 0.9}, 1.0).success);
  const std::size_t before = fibers.messages.size();
  EXPECT_TRUE(node_test::wait_for([&] { return fibers.messages.size() > before + 3; }));
  pause(true);
  const StepSimulation::Response paused = step.get();
  expect_refused(paused, "~pause ended it after ");
  expect_refused(paused, " of 1000000 frames");
  EXPECT_GT(paused.time, 0.0);

  step = step_in_background();
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  expect_refused(step.get(), "~reset began the scene again after ");
  EXPECT_EQ(try_step(0).time, 0.0);
  EXPECT_TRUE(try_step(2).success);
}

/// With handles from rviz.
TEST_F(CableSimLimitsTest, AHandleDoesNotTearTheFibre) {
  using visualization_msgs::InteractiveMarkerFeedback;
  const node_test::Recorder<rosgraph_msgs::Log> logs{node, "/rosout"};
  const auto publisher = node_test::advertise<InteractiveMarkerFeedback>(
      node, "/cable_sim/interactive_markers/feedback");
  ASSERT_TRUE(node_test::wait_for([&] { return publisher.getNumSubscribers() > 0; }));
  InteractiveMarkerFeedback feedback;
  feedback.header.frame_id = "world";
  feedback.client_id = "test";
  feedback.marker_name = "cable/first";
  feedback.event_type = InteractiveMarkerFeedback::POSE_UPDATE;
  feedback.pose.orientation.w = 1.0;
  // 1.2 m of cable, stretched by a tenth (max_strain). The other end goes on along its path, and
  // what that adds is not the handle's: where it stays, the ends move apart all the same. So in
  // each frame the handle ends within reach of where the other end is then, or no further than had
  // it stayed.
  constexpr double reach = 1.1 * 1.2;
  double farthest = 0.0;
  std::vector<Vector3d> before = points_after(1);
  for (const double x : {-100.0, -1e200, nan, -infinity}) {
    feedback.pose.position.x = x;
    publisher.publish(feedback);
    for (int frame = 0; frame < 100; ++frame) {
      const std::vector<Vector3d> points = points_after(1);
      const double apart = (points[0] - points[60]).norm();
      const double had_it_stayed = (before[0] - points[60]).norm();
      ASSERT_LE(apart, std::max(reach, had_it_stayed) + 1e-6);
      ASSERT_NEAR((points[60] - Vector3d(0.4, 0.0, 1.0)).norm(), 0.0, 0.6);  // on its path
      farthest = std::max(farthest, apart);
      before = points;
    }
  }
  EXPECT_GT(farthest, reach - 1e-3) << "the handle was not followed as far as the cable reaches";
  EXPECT_NE(logs.wait_for([](const rosgraph_msgs::Log& log) {
    return log.msg.find("the handle cable/first is not followed further: position") == 0;
  }),
            nullptr);
}

}  // namespace
