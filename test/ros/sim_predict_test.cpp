// What a simulation says of the time to come, beside what comes. The scene is sim_forces.yaml,
// paused.
#include <tf2_ros/static_transform_broadcaster.h>

#include <algorithm>
#include <future>

#include "fiber_proximity/Predict.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "test/ros/cable_sim_fixture.hpp"
#include "test/ros/messages.hpp"

namespace {

using Eigen::Vector3d;
using fiber_proximity::Contact;
using fiber_proximity::HoldTrajectory;
using fiber_proximity::Predict;
using fiber_proximity_ros::to_message;
using fiber_proximity_ros::to_vector;

geometry_msgs::Pose pose_at(const Vector3d& place) {
  return to_message(Eigen::Isometry3d(Eigen::Translation3d(place)));
}

class SimPredictTest : public CableSimTest {
 protected:
  void SetUp() override {
    broadcaster_.sendTransform(test_messages::transform("gripper", {0.0, 0.0, 1.0}));
    reset();
    points_after(30);  // none of these is on its way any more
  }

  Predict::Response predict(const Predict::Request& request) {
    return call<Predict>("predict", request);
  }

  static Predict::Request request_of(double duration) {
    Predict::Request request;
    request.duration = duration;
    request.margin = 0.05;
    return request;
  }

  static std::vector<Vector3d> points_of(const fiber_proximity::FiberArray& fibers) {
    return node_test::to_assembly(fibers).points();
  }

 private:
  tf2_ros::StaticTransformBroadcaster broadcaster_;
};

TEST_F(SimPredictTest, WhatIsToldIsWhatComes) {
  const std::vector<Vector3d> before = points_after(1);
  // The lying rod is taken by its first node, which is the twelfth of the scene, and lifted.
  fiber_proximity::AttachFiber::Request attach;
  attach.fiber = "lying";
  attach.node = 0;
  attach.position = to_message(Vector3d(before[11] + Vector3d(0.0, 0.0, 0.1)));
  attach.speed = 0.25;
  Predict::Request request = request_of(0.5);
  request.sample_period = 0.25;
  HoldTrajectory& trajectory = request.trajectories.emplace_back();
  trajectory.fiber = attach.fiber;
  trajectory.node = attach.node;
  trajectory.times = {(to_vector(attach.position) - before[11]).norm() / attach.speed};
  trajectory.poses = {pose_at(to_vector(attach.position))};
  const Predict::Response told = predict(request);
  ASSERT_TRUE(told.success) << told.message;
  ASSERT_EQ(told.samples.size(), 3U);
  EXPECT_EQ(points_of(told.samples[0]), before);
  EXPECT_NEAR(told.time, 0.5, 1e-9);
  ASSERT_TRUE(call<fiber_proximity::AttachFiber>("attach", attach).success);
  EXPECT_EQ(points_of(told.samples[1]), points_after(15));
  const std::vector<Vector3d> after = points_after(15);
  EXPECT_EQ(points_of(told.samples[2]), after);
  EXPECT_GT(after[11].z(), before[11].z() + 0.09) << "it is lifted";
  EXPECT_EQ(told.samples[2].names, fibers.messages.back()->names);
  ASSERT_EQ(told.object_names, std::vector<std::string>{"table"});
  const auto touch = std::find_if(told.touches.begin(), told.touches.end(),
                                  [](const auto& each) { return each.fiber == 1; });
  ASSERT_NE(touch, told.touches.end());
  EXPECT_EQ(touch->type_b, Contact::OBJECT);
  EXPECT_GT(touch->force, 0.0);
  ASSERT_EQ(told.clearances.size(), told.clearance_times.size());
  ASSERT_EQ(told.warnings.size(), 1U);
  EXPECT_NE(told.warnings[0].find("of fibre 'heavy' pulls with 0.05 N, its greatest force"),
            std::string::npos)
      << told.warnings[0];
  EXPECT_GT(told.warning_times.at(0), 0.0);
  ASSERT_EQ(told.tensions.size(), 3U);
  EXPECT_GT(told.tensions[1].force, 0.01);
}

TEST_F(SimPredictTest, AFrameCarriesWhatItHolds) {
  Predict::Request request = request_of(1.0);
  HoldTrajectory& trajectory = request.trajectories.emplace_back();
  trajectory.frame = "gripper";
  trajectory.times = {0.8};
  trajectory.poses = {pose_at({0.2, 0.0, 1.2})};
  const Predict::Response told = predict(request);
  ASSERT_TRUE(told.success) << told.message;
  ASSERT_EQ(told.samples.size(), 1U);
  // It holds the first node at (0.05, 0.1, 0) of its own.
  const Vector3d held = points_of(told.samples[0]).front();
  EXPECT_LT((held - Vector3d(0.25, 0.1, 1.2)).norm(), 1e-3) << held.transpose();
}

TEST_F(SimPredictTest, SeveralAreMadeAtOnce) {
  const Predict::Request request = request_of(2.0);
  const Predict::Response alone = predict(request);
  ASSERT_TRUE(alone.success) << alone.message;
  std::vector<std::future<Predict::Response>> told;
  for (int i = 0; i < 4; ++i) {
    told.push_back(std::async(std::launch::async, [&request] {
      Predict service;
      service.request = request;
      EXPECT_TRUE(node_test::call_service_alone("/cable_sim/predict", service));
      return service.response;
    }));
  }
  for (auto& each : told) {
    const Predict::Response answer = each.get();
    ASSERT_TRUE(answer.success) << answer.message;
    EXPECT_EQ(points_of(answer.samples.at(0)), points_of(alone.samples.at(0)));
  }
  EXPECT_EQ(points_after(120), points_of(alone.samples.at(0))) << "the scene goes on as it would";
}

TEST_F(SimPredictTest, WhatMayNotBeAskedIsRefused) {
  const auto error = [this](const HoldTrajectory& trajectory) {
    Predict::Request request = request_of(1.0);
    request.trajectories = {trajectory};
    const Predict::Response told = predict(request);
    EXPECT_FALSE(told.success);
    EXPECT_TRUE(told.samples.empty());
    return told.message;
  };
  HoldTrajectory trajectory;
  trajectory.fiber = "rope";
  EXPECT_EQ(error(trajectory), "trajectory 0: there is no fibre 'rope'");
  trajectory.fiber = "lying";
  EXPECT_EQ(error(trajectory), "trajectory 0: it has no entries");
  trajectory.times = {1.0};
  EXPECT_EQ(error(trajectory), "trajectory 0: there are 1 times for 0 poses");
  trajectory.poses = {pose_at({0, 0, 1})};
  trajectory.poses[0].orientation.w = 0.5;
  EXPECT_EQ(error(trajectory).find("trajectory 0: pose 0: "), 0U) << "no unit quaternion";
  trajectory.poses = {pose_at({0, 0, 1e9})};
  EXPECT_NE(error(trajectory).find("at most 1e+03 m/s are allowed"), std::string::npos);
  trajectory = HoldTrajectory();
  trajectory.frame = "nowhere";
  EXPECT_EQ(error(trajectory),
            "trajectory 0: nothing is held by frame 'nowhere', and no obstacle follows it");
  EXPECT_EQ(predict(request_of(-1.0)).message,
            "duration is -1 s, it must be more than 0 and at most 3.6e+03");
}

}  // namespace
