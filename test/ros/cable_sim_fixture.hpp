#pragma once

#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <string>
#include <vector>

#include "fiber_proximity/AttachFiber.h"
#include "fiber_proximity/DetachFiber.h"
#include "fiber_proximity/SetSimulationParameters.h"
#include "fiber_proximity/StepSimulation.h"
#include "test/ros/node_test.hpp"

/// Asks a running simulation's node, /cable_sim.
class CableSimTest : public ::testing::Test {
 protected:
  template <class Service>
  typename Service::Response call(const std::string& name,
                                  const typename Service::Request& request = {}) {
    Service service;
    service.request = request;
    EXPECT_TRUE(node_test::call_service("/cable_sim/" + name, service)) << name;
    return service.response;
  }

  void pause(bool is_paused) {
    std_srvs::SetBool::Request request;
    request.data = static_cast<decltype(request.data)>(is_paused);
    EXPECT_TRUE(call<std_srvs::SetBool>("pause", request).success);
  }

  /// And waits for what is published then, as what was before may still be on its way.
  void reset() {
    const ros::Time asked = ros::Time::now();
    EXPECT_TRUE(call<std_srvs::Trigger>("reset").success);
    EXPECT_TRUE(node_test::wait_for(
        [&] { return !fibers.messages.empty() && fibers.messages.back()->header.stamp >= asked; }));
  }

  double step(std::uint32_t frames) {
    fiber_proximity::StepSimulation::Request request;
    request.frames = frames;
    const auto response = call<fiber_proximity::StepSimulation>("step", request);
    EXPECT_TRUE(response.success);
    return response.time;
  }

  /// Where the fibre is after so many frames.
  std::vector<Eigen::Vector3d> points_after(std::uint32_t frames) {
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
