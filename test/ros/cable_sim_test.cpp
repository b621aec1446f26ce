// The simulation's node through the real graph.
#include <tf2_ros/transform_broadcaster.h>
#include <visualization_msgs/InteractiveMarkerFeedback.h>
#include <visualization_msgs/InteractiveMarkerInit.h>

#include <optional>
#include <stdexcept>

#include "fiber_proximity/ObstacleArray.h"
#include "src/ros/sim/sim_server.hpp"
#include "test/ros/cable_sim_fixture.hpp"
#include "test/ros/messages.hpp"

namespace {

using Eigen::Vector3d;

TEST_F(CableSimTest, StepsWhenAskedAndStartsAgainTheSame) {
  pause(true);
  reset();
  const std::vector<Vector3d> first = points_after(30);
  EXPECT_NEAR(step(0), 0.5, 1e-9);
  const std::vector<Vector3d> later = points_after(30);
  EXPECT_GT((later[30] - first[30]).norm(), 1e-3);
  reset();
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
  const ros::SteadyTime start = ros::SteadyTime::now();
  const double begin = step(0);
  pause(false);
  // It may fall behind on a busy machine, but never run ahead.
  const std::size_t before = fibers.messages.size();
  EXPECT_TRUE(node_test::wait_for([&] { return fibers.messages.size() > before + 60; }));
  pause(true);
  const double end = step(0);
  EXPECT_GE(end - begin, 59.0 / 60.0);
  EXPECT_LT(end - begin, (ros::SteadyTime::now() - start).toSec() + 0.1);
  EXPECT_EQ(step(0), end);
}

TEST_F(CableSimTest, TakesHoldOfNodesAndLetsGo) {
  pause(true);
  reset();
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

TEST_F(CableSimTest, ParametersChangeWhileItRuns) {
  using SetParameters = fiber_proximity::SetSimulationParameters;
  const auto set = [this](const std::string& name, const std::vector<double>& value) {
    SetParameters::Request request;
    request.parameters.emplace_back();
    request.parameters.back().name = name;
    request.parameters.back().value = value;
    return call<SetParameters>("set_parameters", request);
  };
  pause(true);
  reset();
  const double hanging = points_after(30)[30].z();
  EXPECT_LT(hanging, 0.8);
  const auto changed = set("gravity.acceleration", {0.0, 0.0, 9.81});
  EXPECT_TRUE(changed.success) << changed.message;
  EXPECT_GT(points_after(60)[30].z(), 1.1) << "gravity does not pull upwards";

  const auto refused = set("damping.relaxation_time", {-1.0});
  EXPECT_FALSE(refused.success);
  EXPECT_EQ(refused.message,
            "parameter 'damping.relaxation_time' is [-1.000000]: damping: the relaxation time is "
            "-1.000000 s, it must be at least 0 and finite");
  ASSERT_EQ(refused.parameters.size(), 2U);
  EXPECT_EQ(refused.parameters[0].name, "damping.relaxation_time");
  EXPECT_EQ(refused.parameters[0].value, std::vector<double>{0.02});
  EXPECT_EQ(refused.parameters[1].value, (std::vector<double>{0.0, 0.0, 9.81}));
  EXPECT_EQ(set("friction.coefficient", {0.5}).message,
            "parameter 'friction.coefficient' is [0.500000]: there is no such parameter, known "
            "are: damping.relaxation_time, gravity.acceleration");
  // A new beginning is that of the file.
  reset();
  EXPECT_LT(points_after(30)[30].z(), 0.8);
}

TEST_F(CableSimTest, AnEndIsDraggedByItsHandle) {
  using visualization_msgs::InteractiveMarkerFeedback;
  const node_test::Recorder<visualization_msgs::InteractiveMarkerInit> handles{
      node, "/cable_sim/interactive_markers/update_full"};
  const auto publisher = node_test::advertise<InteractiveMarkerFeedback>(
      node, "/cable_sim/interactive_markers/feedback");
  ASSERT_TRUE(node_test::wait_for([&] { return publisher.getNumSubscribers() > 0; }));
  const auto* init = handles.wait_for([](const auto& message) { return !message.markers.empty(); });
  ASSERT_NE(init, nullptr);
  ASSERT_EQ(init->markers.size(), 2U);
  EXPECT_EQ(init->markers[0].name, "cable/first");
  EXPECT_EQ(init->markers[1].name, "cable/last");
  EXPECT_EQ(init->markers[1].header.frame_id, "world");

  pause(true);
  reset();
  InteractiveMarkerFeedback feedback;
  feedback.header.frame_id = "world";
  feedback.client_id = "test";
  feedback.marker_name = "cable/first";
  feedback.pose.position.x = -0.3;
  feedback.pose.position.z = 1.2;
  feedback.pose.orientation.w = 1.0;
  const Vector3d target(-0.3, 0.0, 1.2);
  const auto send = [&](std::uint8_t event) {
    feedback.event_type = event;
    publisher.publish(feedback);
  };
  send(InteractiveMarkerFeedback::POSE_UPDATE);
  // Feedback and services come in any order: frame by frame, until it has come.
  Vector3d before = points_after(1)[0];
  Vector3d here = before;
  EXPECT_TRUE(node_test::wait_for([&] {
    before = here;
    here = points_after(1)[0];
    EXPECT_LT((here - before).norm(), 2.0 / 60.0 + 1e-9) << "faster than a hand";
    return (here - target).norm() < 1e-9;
  }));
  // The scene held this end: it stays where it is left.
  send(InteractiveMarkerFeedback::MOUSE_UP);
  EXPECT_NEAR((points_after(30)[0] - target).norm(), 0.0, 1e-9);
}

class SimFramesTest : public CableSimTest {
 protected:
  /// The node waits for the gripper when it is loaded.
  void SetUp() override {
    ASSERT_TRUE(node_test::wait_for([this] {
      send({0.0, -0.05, 1.05});
      return !fibers.messages.empty();
    }));
  }

  void send(const Vector3d& gripper) {
    broadcaster_.sendTransform(test_messages::transform("gripper", gripper));
  }

  /// Where the fibre's first node is after a frame with the gripper there; none: without a word.
  Vector3d step_with(const std::optional<Vector3d>& gripper) {
    if (gripper) {
      send(*gripper);
    }
    return points_after(1)[0];
  }

  /// [m] A hold is a spring a thousand times as stiff as an edge of 5 cm, which is stretched by a
  /// tenth at most.
  static constexpr double sag = 0.1 * 0.05 / 1000;

  /// Until the fibre's first node is there.
  bool reaches(const Vector3d& gripper, const Vector3d& wanted) {
    return node_test::wait_for([&] { return (step_with(gripper) - wanted).norm() < sag; });
  }

  bool is_logged(const std::string& text) {
    return logs.wait_for([&](const rosgraph_msgs::Log& log) {
      return log.msg.find(text) != std::string::npos;
    }) != nullptr;
  }

  node_test::Recorder<rosgraph_msgs::Log> logs{node, "/rosout"};

 private:
  tf2_ros::TransformBroadcaster broadcaster_;
};

TEST_F(SimFramesTest, AGripperFollowsItsFrameAndFreezesWhereThatIsLost) {
  const Vector3d offset(0.0, 0.1, 0.0);
  ASSERT_TRUE(reaches({0.0, -0.05, 1.05}, Vector3d(0.0, -0.05, 1.05) + offset));
  const Vector3d last(0.02, -0.05, 1.1);
  ASSERT_TRUE(reaches(last, last + offset));
  // Nothing more is heard of the frame: it stays, and that is said, with where it stands.
  const ros::SteadyTime start = ros::SteadyTime::now();
  while ((ros::SteadyTime::now() - start).toSec() < 1.0) {
    EXPECT_LT((step_with(std::nullopt) - last - offset).norm(), sag);
  }
  EXPECT_TRUE(
      is_logged("sim_frames.yaml:15: effects[4].attachment[0]: node 0 of fibre 'cable' stays "
                "where it is: nothing new of frame 'gripper'"));
  const Vector3d again(0.05, 0.0, 1.0);
  ASSERT_TRUE(reaches(again, again + offset));
  EXPECT_TRUE(is_logged("node 0 of fibre 'cable' follows frame 'gripper' again"));
}

/// Of 0.5 m of fibre, stretched by a tenth; and no number that is none.
TEST_F(SimFramesTest, AGripperLeadsAFibreAsFarAsItReaches) {
  const Vector3d offset(0.0, 0.1, 0.0);
  ASSERT_TRUE(reaches({0.0, -0.1, 1.0}, {0.0, 0.0, 1.0}));
  fiber_proximity::AttachFiber::Request hold;
  hold.fiber = "cable";
  hold.node = -1;
  const Vector3d last = points_after(1)[10];
  hold.position.x = last.x();
  hold.position.y = last.y();
  hold.position.z = last.z();
  const auto held = call<fiber_proximity::AttachFiber>("attach", hold);
  ASSERT_TRUE(held.success) << held.message;
  for (const double x : {-5.0, -1e200, -1e308}) {
    for (int i = 0; i < 60; ++i) {
      EXPECT_LE((step_with(Vector3d(x, 0.0, 1.0)) - last).norm(), 0.55 + 1e-9);
    }
  }
  EXPECT_TRUE(is_logged("node 0 of fibre 'cable' does not follow frame 'gripper': position ("));
  const Vector3d back(0.0, -0.1, 1.02);
  ASSERT_TRUE(reaches(back, back + offset));
  EXPECT_TRUE(is_logged("node 0 of fibre 'cable' follows frame 'gripper' again"));
  fiber_proximity::DetachFiber::Request release;
  release.fiber = "cable";
  release.node = -1;
  EXPECT_TRUE(call<fiber_proximity::DetachFiber>("detach", release).success);
}

TEST_F(SimFramesTest, AFrameThatDoesNotComeIsAnErrorWhenTheSceneIsLoaded) {
  using namespace fiber_proximity_ros;
  // tf of this one hears nothing: the gripper was sent before.
  const ros::NodeHandle second("/second_cable_sim");
  second.setParam("scene", node.param<std::string>("/cable_sim/scene", ""));
  second.setParam("frame_wait", 0.2);
  try {
    const SimServer server(node, second, read_sim_options(node, second));
    ADD_FAILURE() << "it does not wait";
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("sim_frames.yaml:15: effects[4].attachment[0]: node 0 of fibre 'cable': "
                           "nothing of frame 'gripper' in 0.200000 s"),
              std::string::npos)
        << message;
  }
}

TEST_F(SimFramesTest, TellsOthersItsObstacles) {
  const node_test::Recorder<fiber_proximity::ObstacleArray> obstacles{node, "/cable_sim/obstacles"};
  const auto* message = obstacles.wait_for([](const auto&) { return true; });
  ASSERT_NE(message, nullptr);
  ASSERT_EQ(message->obstacles.size(), 1U);
  EXPECT_EQ(message->obstacles[0].id, "table");
  EXPECT_EQ(message->obstacles[0].header.frame_id, "world");
}

}  // namespace
