// What acts in the simulation's fibres and on them, through the real graph.
#include <geometry_msgs/WrenchStamped.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <visualization_msgs/MarkerArray.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fiber_proximity/ForceArray.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "test/ros/cable_sim_fixture.hpp"
#include "test/ros/messages.hpp"

namespace {

using Eigen::Vector3d;
using fiber_proximity_ros::to_vector;

/// [N] of each rod: half a metre of silicone tube of 5 mm radius, 1150 kg/m3.
const double weight = 9.81 * 1150.0 * M_PI * 0.005 * 0.005 * 0.5;

const double load = 0.05;  // [N] on 10 cm in the middle of the one that lies

class SimForcesTest : public CableSimTest {
 protected:
  /// The gripper is turned by a quarter about x: its y is the world's z.
  void SetUp() override {
    broadcaster_.sendTransform(
        test_messages::transform(test_messages::header("world", ros::Time::now()), "gripper",
                                 Eigen::Translation3d(-0.05, 0.0, 0.9) *
                                     Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitX())));
    ASSERT_TRUE(node_test::wait_for([&] {
      step(1);
      return !forces.messages.empty() && !wrenches.messages.empty() && !markers.messages.empty();
    }));
    step(600);
    const double end = step(1);
    ASSERT_GT(end, 10.0);
    const ros::Time asked = ros::Time::now();
    step(1);
    ASSERT_TRUE(node_test::wait_for([&] {
      return forces.messages.back()->header.stamp >= asked &&
             wrenches.messages.back()->header.stamp >= asked &&
             markers.messages.back()->markers.front().header.stamp >= asked;
    }));
  }

  /// What acts after the last frame.
  const fiber_proximity::ForceArray& last() const { return *forces.messages.back(); }

  static bool is_near(const Vector3d& value, const Vector3d& expected, double tolerance) {
    EXPECT_LT((value - expected).norm(), tolerance)
        << value.transpose() << " instead of " << expected.transpose();
    return (value - expected).norm() < tolerance;
  }

  node_test::Recorder<fiber_proximity::ForceArray> forces{node, "/cable_sim/forces"};
  node_test::Recorder<geometry_msgs::WrenchStamped> wrenches{node,
                                                             "/cable_sim/wrenches/hanging_rod/0"};
  node_test::Recorder<visualization_msgs::MarkerArray> markers{node, "/cable_sim/force_markers"};
  node_test::Recorder<rosgraph_msgs::Log> logs{node, "/rosout"};

 private:
  tf2_ros::StaticTransformBroadcaster broadcaster_;
};

TEST_F(SimForcesTest, TensionsAndHoldsCarryWhatHangs) {
  const fiber_proximity::ForceArray& message = last();
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.names, (std::vector<std::string>{"hanging rod", "lying", "heavy"}));
  EXPECT_EQ(message.offsets, (std::vector<std::uint32_t>{0, 11, 22, 33}));
  ASSERT_EQ(message.tensions.size(), 33U);
  ASSERT_EQ(message.bending_moments.size(), 33U);
  ASSERT_EQ(message.twisting_moments.size(), 33U);
  for (std::size_t edge = 0; edge < 10; ++edge) {
    // What is below its middle.
    const double below = weight * (0.95 - 0.1 * static_cast<double>(edge));
    EXPECT_NEAR(message.tensions[edge], below, 1e-3 * weight) << edge;
    EXPECT_NEAR(to_vector(message.bending_moments[edge]).norm(), 0.0, 1e-4 * weight);
  }
  EXPECT_EQ(message.tensions[10], 0.0) << "no edge begins there";
  ASSERT_EQ(message.holds.size(), 2U);
  EXPECT_EQ(message.holds[0].fiber, 0U);
  EXPECT_EQ(message.holds[0].node, 0U);
  is_near(to_vector(message.holds[0].point), {0, 0, 1}, 1e-5);
  is_near(to_vector(message.holds[0].force), {0, 0, weight}, 1e-3 * weight);
  EXPECT_LE(message.residual, 1e-6);
  EXPECT_LE(message.energy_gain, 1e-9);
}

TEST_F(SimForcesTest, AWrenchIsWhatASensorInTheGripperMeasures) {
  const geometry_msgs::WrenchStamped& wrench = *wrenches.messages.back();
  EXPECT_EQ(wrench.header.frame_id, "gripper");
  is_near(to_vector(wrench.wrench.force), {0, -weight, 0}, 1e-3 * weight);
  is_near(to_vector(wrench.wrench.torque), {0, 0, -0.05 * weight}, 1e-4 * weight);
}

TEST_F(SimForcesTest, ContactsCarryWhatLies) {
  Vector3d on_lying = Vector3d::Zero();
  Vector3d on_heavy = to_vector(last().holds[1].force);
  for (const fiber_proximity::ContactForce& contact : last().contacts) {
    EXPECT_EQ(contact.object, "table");
    EXPECT_NEAR(contact.point.z, 0.0, 0.1 * 0.005) << "between the surfaces";
    const Vector3d force = to_vector(contact.normal_force) + to_vector(contact.friction_force);
    EXPECT_NE(contact.fiber, 0U) << "it hangs";
    (contact.fiber == 1 ? on_lying : on_heavy) += force;
  }
  is_near(on_lying, {0, 0, weight + load}, 2e-3 * weight);
  is_near(on_heavy, {0, 0, weight}, 2e-3 * weight);
}

TEST_F(SimForcesTest, LoadsActWhereTheSceneSays) {
  Vector3d sum = Vector3d::Zero();
  Vector3d moment = Vector3d::Zero();  // about the middle of the rod
  for (const fiber_proximity::LoadForce& each : last().loads) {
    EXPECT_EQ(each.load, 0U);
    EXPECT_EQ(each.fiber, 1U);
    EXPECT_TRUE(4 <= each.node && each.node <= 6) << each.node;
    EXPECT_NEAR(each.point.y, -0.25 + 0.05 * each.node, 1e-4);
    const Vector3d force = to_vector(each.force);
    sum += force;
    moment += (to_vector(each.point) - Vector3d(0.3, 0.0, 0.0)).cross(force);
  }
  is_near(sum, {0, 0, -load}, 1e-9);
  EXPECT_NEAR(moment.x(), 0.0, 1e-5);
}

TEST_F(SimForcesTest, AHoldThatIsTooWeakLagsAndSaysSo) {
  ASSERT_EQ(last().holds.size(), 2U);
  const fiber_proximity::HoldForce& hold = last().holds[1];
  EXPECT_EQ(hold.max_force, 0.05);
  EXPECT_NEAR(to_vector(hold.force).norm(), 0.05, 1e-9);
  EXPECT_NEAR(hold.lag, (to_vector(hold.point) - Vector3d(0.6, 0.25, 0.12)).norm(), 1e-12);
  EXPECT_GT(hold.lag, 0.02);
  EXPECT_GT(hold.point.z, 0.006) << "it pulls all the same";
  // It does not say so in each frame.
  const std::string lag =
      "what holds node 10 of fibre 'heavy' pulls with 0.05 N, its greatest force (max_force), and "
      "the node is 0.11 m behind";
  EXPECT_TRUE(node_test::wait_for([&] {
    step(1);
    return std::any_of(logs.messages.begin(), logs.messages.end(),
                       [&lag](const auto& log) { return log->msg.find(lag) != std::string::npos; });
  }));
}

TEST_F(SimForcesTest, DrawsThemWithALegend) {
  std::set<std::string> texts;
  std::size_t colored = 0;
  double longest = 0.0;
  for (const visualization_msgs::Marker& marker : markers.messages.back()->markers) {
    ASSERT_EQ(marker.action, visualization_msgs::Marker::ADD);
    if (marker.ns == "tensions") {
      EXPECT_EQ(marker.points.size(), 20U);
      for (const std_msgs::ColorRGBA& color : marker.colors) {
        colored += color.r > 0.94F && color.b < 0.9F ? 1U : 0U;
      }
    } else if (marker.ns == "holds") {
      ASSERT_EQ(marker.points.size(), 2U);
      const Vector3d way = to_vector(marker.points[1]) - to_vector(marker.points[0]);
      EXPECT_GT(way.z(), 0.0);
      longest = std::max(longest, way.norm());
    } else if (marker.ns == "legend") {
      texts.insert(marker.text.substr(marker.text.find_first_not_of('\n')));
    }
  }
  EXPECT_GE(colored, 10U) << "the hanging rod's tension is seen";
  EXPECT_GT(longest, 0.05);
  ASSERT_EQ(texts.size(), 4U);
  // 0.44 N, rounded up.
  EXPECT_EQ(texts.begin()->find("blue: pressure, up to 0.5 N"), 0U) << *texts.begin();
}

}  // namespace
