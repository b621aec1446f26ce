// Octomaps, through octomap_bridge, in the running node's environment.
#include <octomap_msgs/conversions.h>

#include "test/ros/bridge_fixture.hpp"

namespace {

using octomap_msgs::Octomap;

class OctomapBridgeTest : public bridge_test::BridgeTest {
 protected:
  void SetUp() override {
    BridgeTest::SetUp();
    maps_ = advertise<Octomap>("octomap");
  }

  /// A map of 0.5 m with one cell that is occupied, from x to x + 0.5, and a free one.
  template <class Tree>
  static Tree tree(float x) {
    Tree tree(0.5);
    tree.updateNode(octomap::point3d(x + 0.25F, 0.25F, 0.25F), true);
    tree.updateNode(octomap::point3d(0.25F, 0.25F, 0.25F), false);
    return tree;
  }

  template <class Tree>
  static Octomap full(const Tree& tree) {
    Octomap map;
    EXPECT_TRUE(octomap_msgs::fullMapToMsg(tree, map));
    map.header = test_messages::header("world");
    return map;
  }

  template <class Tree>
  static Octomap binary(const Tree& tree) {
    Octomap map;
    EXPECT_TRUE(octomap_msgs::binaryMapToMsg(tree, map));
    map.header = test_messages::header("world");
    return map;
  }

  void expect_refusal(const Octomap& map, const std::string& reason) {
    maps_.publish(map);
    expect_log("'/octomap' (octomap_msgs/Octomap): message refused: " + reason);
    // Refusals are logged at a low rate.
    ros::SteadyTime begin = ros::SteadyTime::now();
    node_test::wait_for([&] { return (ros::SteadyTime::now() - begin).toSec() > 1.1; });
  }

  ros::Publisher maps_;
};

TEST_F(OctomapBridgeTest, TheNewestMapIsThere) {
  maps_.publish(full(tree<octomap::OcTree>(3.0F)));
  expect_distances({{"cloud", {3.0}}});
  maps_.publish(binary(tree<octomap::OcTree>(4.0F)));
  expect_distances({{"cloud", {4.0}}});
  maps_.publish(full(tree<octomap::ColorOcTree>(5.0F)));
  expect_distances({{"cloud", {5.0}}});
  maps_.publish(binary(tree<octomap::ColorOcTree>(6.0F)));
  expect_distances({{"cloud", {6.0}}});
  maps_.publish(binary(octomap::OcTree(0.5)));
  expect_distances({});
}

TEST_F(OctomapBridgeTest, AMapThatCannotBeReadIsAnErrorAndChangesNothing) {
  const Octomap good = full(tree<octomap::OcTree>(3.0F));
  maps_.publish(good);
  expect_distances({{"cloud", {3.0}}});
  Octomap bad = good;
  bad.id = "CountingOcTree";
  expect_refusal(bad, "id is 'CountingOcTree', it must be OcTree, ");
  bad = good;
  bad.resolution = -0.5;
  expect_refusal(bad, "resolution is -0.5, it must be the edge of a cell in metres");
  bad = good;
  bad.data.pop_back();
  expect_refusal(bad, "data end after ");
  bad = good;
  bad.data.assign(1'000'000, 3);
  expect_refusal(bad, "the octree is deeper than 16 levels at byte ");
  expect_distances({{"cloud", {3.0}}});
  maps_.publish(full(tree<octomap::OcTree>(4.0F)));
  expect_distances({{"cloud", {4.0}}});
}

}  // namespace
