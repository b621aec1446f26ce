// The simulation's node with a scene of the test's own, good or bad, through the real graph.
#include <geometry_msgs/WrenchStamped.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <future>

#include "fiber_proximity/AttachFiber.h"
#include "fiber_proximity/DetachFiber.h"
#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/SetSimulationParameters.h"
#include "fiber_proximity/StepSimulation.h"
#include "test/ros/own_scene_fixture.hpp"
#include "test/support/answers.hpp"

namespace {

using fiber::test::ProcessResult;
using fiber_proximity::AttachFiber;
using fiber_proximity::DetachFiber;
using fiber_proximity::SetSimulationParameters;
using fiber_proximity::StepSimulation;

TEST_F(OwnSceneTest, SigintEndsALongStep) {
  write(scene(fiber("cable", "[0, 0, 0]", "[1, 0, 0]"), "  - stretch\n"));
  node_test::RunningNode own_sim(command());
  const node_test::Recorder<fiber_proximity::FiberArray> fibers{node, "/own_sim/fibers"};
  ASSERT_TRUE(step(0).success);
  auto answer = std::async(std::launch::async, [] {
    StepSimulation service;
    service.request.frames = 1000000;
    node_test::call_service_alone("/own_sim/step", service);
  });
  ASSERT_TRUE(node_test::wait_for([&] { return fibers.messages.size() > 3; }));
  own_sim.send(SIGINT);
  EXPECT_TRUE(node_test::wait_for([&] { return !own_sim.is_running(); }));
  EXPECT_EQ(own_sim.wait(), 0);
  answer.wait();
}

/// Nothing that a scene asks for ends the process: it stops, says so once, and begins again.
TEST_F(OwnSceneTest, ASimulationThatFailsStopsAndBeginsAgain) {
  const std::string fibers =
      fiber("one", "[0, 0, 0.5]", "[1, 0, 0.5]") + fiber("two", "[0, 0.1, 0.5]", "[1, 0.1, 0.5]");
  const auto with_path = [&fibers](const std::string& path) {
    return scene(fibers,
                 "  - gravity\n  - stretch\n  - bend\n  - fiber_contact\n  - attachment: "
                 "[{fiber: one, path: [" +
                     path + "]}]\n");
  };
  write(with_path("{time: 0}, {time: 0.5}, {time: 1, position: [-0.1, 0, 0.5]}"));
  std::vector<std::string> failing = command();
  failing.front() = FAILING_CABLE_SIM;
  node_test::RunningNode own_sim(failing, folder_.path("output.txt"));
  ASSERT_TRUE(step(0).success);
  const StepSimulation::Response failed = step(100);
  EXPECT_FALSE(failed.success);
  EXPECT_EQ(failed.message.find("the simulation has stopped after "), 0U) << failed.message;
  EXPECT_NE(failed.message.find("position must be finite; ~reset begins again"), std::string::npos)
      << failed.message;
  EXPECT_GT(failed.time, 0.4);
  EXPECT_LT(failed.time, 0.51);
  EXPECT_EQ(step(0).message, failed.message);
  EXPECT_EQ(step(5).message, failed.message);
  AttachFiber::Request attach;
  attach.fiber = "one";
  attach.position.z = 0.5;
  EXPECT_EQ(call<AttachFiber>("attach", attach).message, failed.message);
  EXPECT_EQ(call<DetachFiber>("detach").message, failed.message);
  std_srvs::SetBool::Request pause;
  pause.data = 0;  // the timer goes on calling
  EXPECT_EQ(call<std_srvs::SetBool>("pause", pause).message, failed.message);
  EXPECT_EQ(call<SetSimulationParameters>("set_parameters").message, failed.message);
  EXPECT_EQ(call<SetSimulationParameters>("set_parameters").parameters.size(), 1U);
  EXPECT_NE(own_sim.output().find("the simulation has stopped after "), std::string::npos);

  pause.data = 1;
  call<std_srvs::SetBool>("pause", pause);
  write(with_path("{time: 0}, {time: 1, position: [-0.1, 0, 0.5]}"));
  EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
  const StepSimulation::Response again = step(30);
  EXPECT_TRUE(again.success) << again.message;
  EXPECT_NEAR(again.time, 0.5, 1e-9);
  EXPECT_TRUE(own_sim.is_running());
  const std::string output = own_sim.output();
  const std::size_t first = output.find("[ERROR]");
  EXPECT_NE(first, std::string::npos);
  EXPECT_EQ(output.find("[ERROR]", first + 1), std::string::npos) << output;
}

TEST_F(OwnSceneTest, AnotherSceneHasWrenchesOfItsOwn) {
  const auto held = [](const std::string& name) {
    return scene(fiber(name, "[0, 0, 0]", "[1, 0, 0]"),
                 "  - gravity\n  - stretch\n  - attachment: [{fiber: " + name + "}]\n");
  };
  write(held("before"));
  node_test::RunningNode own_sim(command());
  const node_test::Recorder<geometry_msgs::WrenchStamped> before{node,
                                                                 "/own_sim/wrenches/before/0"};
  const node_test::Recorder<geometry_msgs::WrenchStamped> after{node, "/own_sim/wrenches/after/0"};
  const auto come = [](const auto& wrenches) {
    return node_test::wait_for([&] {
      step(1);
      return !wrenches.messages.empty();
    });
  };
  ASSERT_TRUE(come(before));
  write(held("after"));
  ASSERT_TRUE(call<std_srvs::Trigger>("reset").success);
  EXPECT_TRUE(come(after));
}

std::string with_moving_box(const std::string& motion) {
  return "environment:\n  obstacles:\n    - id: box\n      pose: {position: [0.5, 0, -0.06]}\n"
         "      primitives: [{type: box, dimensions: [0.1, 0.1, 0.1]}]\n      motion: " +
         motion + "\n";
}

TEST_F(OwnSceneTest, ObstaclesThatMoveAreToldAndFeelFibres) {
  // It ends where it presses, however many frames go by before anybody listens.
  write(scene(fiber("cable", "[0, 0, 0]", "[1, 0, 0]"),
              "  - stretch\n  - bend\n  - environment_contact\n"
              "  - attachment: [{fiber: cable, node: first}, {fiber: cable, node: last}]\n") +
        with_moving_box("{path: [{time: 0}, {time: 1, position: [0.5, 0, -0.03]}]}"));
  node_test::RunningNode own_sim(command());
  const node_test::Recorder<geometry_msgs::WrenchStamped> wrenches{
      node, "/own_sim/obstacle_wrenches/box"};
  const node_test::Recorder<fiber_proximity::ObstacleArray> obstacles{node, "/own_sim/obstacles"};
  EXPECT_TRUE(node_test::wait_for([&] {
    step(1);
    return !wrenches.messages.empty() && wrenches.messages.back()->wrench.force.z < 0.0;
  }));
  EXPECT_TRUE(node_test::wait_for([&] {
    return !obstacles.messages.empty() &&
           obstacles.messages.back()->obstacles.at(0).pose.position.z > -0.059;
  }));
}

TEST_F(OwnSceneTest, AnObstaclesFrameThatDoesNotComeIsAnError) {
  node.setParam("/own_sim/frame_wait", 0.2);
  write(scene(fiber("cable", "[0, 0, 0]", "[1, 0, 0]"), "  - stretch\n  - environment_contact\n") +
        with_moving_box("{frame: nowhere}"));
  const ProcessResult result = run();
  node.deleteParam("/own_sim/frame_wait");
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("'box'"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("nothing of frame 'nowhere'"), std::string::npos) << result.err;
}

TEST_F(OwnSceneTest, AnAccuracyThatTakesForEverIsRefused) {
  for (const std::string accuracy : {"1e-9", "1e-7 %", "1e-300"}) {
    std::string text =
        scene(fiber("cable", "[0, 0, 0]", "[1, 0, 0]"), "  - gravity\n  - stretch\n");
    text.replace(text.find("    segments: 20\n"), 17, "");
    write(text + "accuracy: " + accuracy + "\n");
    const ProcessResult result = run();
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_NE(result.err.find(accuracy == "1e-300"
                                  ? "segments, 1000000 are the most"
                                  : "accuracy is " + accuracy + ", it must be coarser: it takes "),
              std::string::npos)
        << result.err;
  }
}

TEST_F(OwnSceneTest, FibresThatBeginInEachOtherAreRefusedOrMovedApart) {
  const std::string text = scene(fiber("one", "[-0.5, 0, 0]", "[0.5, 0, 0]") +
                                     fiber("two", "[0, -0.5, 0.004]", "[0, 0.5, 0.004]") +
                                     fiber("three", "[0, 0.1, 0.2]", "[1, 0.1, 0.2]") +
                                     fiber("same", "[0, 0.1, 0.2]", "[1, 0.1, 0.2]"),
                                 "  - stretch\n  - bend\n  - fiber_contact\n");
  write(text);
  const ProcessResult result = run();
  EXPECT_EQ(result.exit_code, 2);
  // The deepest is named: axes that are one, rather than axes that pass each other in 4 mm.
  EXPECT_NE(result.err.find("scene.yaml:12: fibers[2] begins inside of " + file_ +
                            ":17: fibers[3]: segment "),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("more pairs; move them apart, or have `initial_overlap: separate`"),
            std::string::npos)
      << result.err;

  write(text + "initial_overlap: separate\n");
  const node_test::Recorder<fiber_proximity::FiberArray> fibers{node, "/own_sim/fibers"};
  node_test::RunningNode own_sim(command());
  const auto count_near = [](const fiber_proximity::FiberArray& message, double distance) {
    const fiber::FiberAssembly assembly = node_test::to_assembly(message);
    fiber::QueryOptions options;
    options.pairing = fiber::Pairing::DIFFERENT_FIBERS;
    const fiber::QueryResult contacts = fiber::test::brute_force(assembly, options);
    return std::count_if(contacts.contacts.begin(), contacts.contacts.end(),
                         [&](const auto& contact) { return contact.distance < -distance; });
  };
  // The beginning is kept for who comes late, and the node queues one message: frame by frame.
  ASSERT_NE(fibers.wait_for([](const auto&) { return true; }), nullptr);
  for (int frame = 0; frame < 10; ++frame) {
    const auto seq = fibers.messages.back()->header.seq;
    ASSERT_TRUE(step(1).success);
    ASSERT_TRUE(node_test::wait_for([&] { return fibers.messages.back()->header.seq > seq; }));
  }
  EXPECT_EQ(fibers.messages.size(), 11U);
  for (const auto& message : fibers.messages) {
    EXPECT_EQ(count_near(*message, 1e-4), 0) << "deeper than a hundredth of the thickness";
  }
}

}  // namespace
