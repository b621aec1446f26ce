#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/StepSimulation.h"
#include "test/ros/mesh_files.hpp"
#include "test/ros/node_test.hpp"
#include "test/ros/running_node.hpp"
#include "test/support/process.hpp"

/// A node of its own, with a scene of its own.
class OwnSceneTest : public ::testing::Test {
 protected:
  static std::string scene(const std::string& fibers, const std::string& rest) {
    return "fibers:\n" + fibers + "effects:\n" + rest;
  }
  static std::string fiber(const std::string& name, const std::string& from,
                           const std::string& to) {
    return "  - name: " + name + "\n    shape: {line: {from: " + from + ", to: " + to +
           "}}\n    segments: 20\n    radius: 0.005\n    material: silicone_tube\n";
  }
  void write(const std::string& text) const { test_meshes::write(file_, text); }

  std::vector<std::string> command() const {
    return {CABLE_SIM, "__name:=own_sim", "_scene:=" + file_, "_paused:=true"};
  }

  /// Of a node that does not start; one that does, or takes for ever, is ended.
  fiber::test::ProcessResult run() const {
    std::string text = "timeout " + std::to_string(node_test::patience) + " ";
    for (const std::string& part : command()) {
      text += part + " ";
    }
    return fiber::test::run_process(text);
  }

  template <class Service>
  static typename Service::Response call(const std::string& name,
                                         const typename Service::Request& request = {}) {
    Service service;
    service.request = request;
    EXPECT_TRUE(
        ros::service::waitForService("/own_sim/" + name, ros::Duration(node_test::patience)));
    EXPECT_TRUE(node_test::call_service_alone("/own_sim/" + name, service)) << name;
    return service.response;
  }
  static fiber_proximity::StepSimulation::Response step(std::uint32_t frames) {
    fiber_proximity::StepSimulation::Request request;
    request.frames = frames;
    return call<fiber_proximity::StepSimulation>("step", request);
  }

  fiber::test::TemporaryDirectory folder_;
  std::string file_ = folder_.path("scene.yaml");
  ros::NodeHandle node;
};
