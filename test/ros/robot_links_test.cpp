#include "src/ros/environment/robot_links.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <memory>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "test/ros/mesh_files.hpp"
#include "test/support/error_of.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber::test::error_of;

const char* const arm = R"(
<robot name="arm">
  <link name="base">
    <collision><geometry><box size="1 2 3"/></geometry></collision>
    <collision>
      <origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/>
      <geometry><cylinder radius="0.5" length="2"/></geometry>
    </collision>
  </link>
  <link name="camera">
    <visual><geometry><box size="1 1 1"/></geometry></visual>
  </link>
  <link name="hand">
    <collision><geometry><sphere radius="0.25"/></geometry></collision>
    <collision>
      <geometry>
        <mesh filename="package://test_meshes/meshes/tetrahedron.obj" scale="2 2 2"/>
      </geometry>
    </collision>
  </link>
  <joint name="a" type="fixed"><parent link="base"/><child link="hand"/></joint>
  <joint name="b" type="fixed"><parent link="hand"/><child link="camera"/></joint>
</robot>)";

std::string with_geometry(const std::string& geometry) {
  return "<robot name=\"arm\"><link name=\"hand\"><collision><geometry>" + geometry +
         "</geometry></collision></link></robot>";
}

TEST(RobotDescription, CollisionGeometryIsReadAndNothingElse) {
  const test_meshes::Package package;
  const std::vector<RobotLink> links = read_robot(arm, MeshLoader());
  ASSERT_EQ(links.size(), 2U);
  EXPECT_EQ(links[0].frame, "base");
  EXPECT_EQ(links[0].object.name, "robot/base");
  const auto& base = links[0].object.shapes;
  ASSERT_EQ(base.size(), 2U);
  EXPECT_EQ(std::get<fiber::BoxShape>(base[0].shape).size, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(std::get<fiber::CylinderShape>(base[1].shape).radius, 0.5);
  EXPECT_EQ(std::get<fiber::CylinderShape>(base[1].shape).height, 2.0);
  EXPECT_TRUE((base[1].pose * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(0, 1, 1), 1e-14));
  const auto& hand = links[1].object.shapes;
  ASSERT_EQ(hand.size(), 2U);
  EXPECT_EQ(std::get<fiber::SphereShape>(hand[0].shape).radius, 0.25);
  const auto mesh = std::get<std::shared_ptr<const fiber::TriangleMesh>>(hand[1].shape);
  EXPECT_EQ(mesh->triangles().size(), 4U);
  EXPECT_TRUE(mesh->is_closed());
}

TEST(RobotDescription, BadDescriptionsAreRefusedByTheNameOfTheLink) {
  const test_meshes::Package package;
  const auto error_in = [](const std::string& description) {
    return error_of([&] { read_robot(description, MeshLoader()); });
  };
  EXPECT_EQ(error_in("no robot"), "the robot's description is no URDF of a robot (see the log)");
  EXPECT_EQ(error_in("<robot name=\"arm\"><link name=\"hand\"/></robot>"),
            "the robot 'arm' has no collision geometry, it needs that of 1 link at least");
  const std::string mesh =
      error_in(with_geometry("<mesh filename=\"package://test_meshes/no.stl\"/>"));
  EXPECT_EQ(mesh.rfind("link 'hand', collision 0: mesh 'package://test_meshes/no.stl': ", 0), 0U)
      << mesh;
  const std::string file = error_in(with_geometry("<mesh filename=\"file:///etc/passwd\"/>"));
  EXPECT_EQ(file.rfind("link 'hand', collision 0: mesh 'file:///etc/passwd': it must", 0), 0U)
      << file;
  const std::string radius = error_in(with_geometry("<sphere radius=\"-1\"/>"));
  EXPECT_NE(radius.find("robot/hand"), std::string::npos) << radius;
}

/// Two links of one ball each, and what tf would say.
class RobotLinksTest : public ::testing::Test {
 protected:
  RobotLinksTest() : links_({link("base"), link("hand")}, 1.0) {}

  static RobotLink link(const std::string& name) {
    RobotLink link;
    link.frame = name;
    link.object.name = "robot/" + name;
    link.object.shapes.push_back({fiber::SphereShape{0.5}, Eigen::Isometry3d::Identity()});
    return link;
  }

  void put(const std::string& frame, double x, double time) {
    poses_[frame] = {Eigen::Isometry3d(Eigen::Translation3d(x, 0, 0)), ros::Time(time)};
  }

  bool update(double time) {
    const auto find = [this](const std::string& frame, const ros::Time& /*stamp*/) {
      if (poses_.count(frame) == 0) {
        throw TransformUnavailable("no transform of " + frame);
      }
      return poses_[frame];
    };
    return links_.update(ros::Time(time), find, world_, tracks_);
  }

  /// Name and place of all there is.
  std::map<std::string, double> places() const {
    std::map<std::string, double> places;
    for (const fiber::EnvironmentObject& object : world_.environment()->objects()) {
      places[object.name] = object.pose.translation().x();
      EXPECT_EQ(object.shapes.size(), 1U);
    }
    return places;
  }

  /// Of each link that is unknown, its name, since when, and why.
  std::vector<std::string> unknown() const {
    std::vector<std::string> texts;
    for (const Unknown& unknown : links_.unknown()) {
      EXPECT_EQ(unknown.source, "robot");
      texts.push_back(text_of(unknown));
    }
    return texts;
  }

  using Places = std::map<std::string, double>;
  using Strings = std::vector<std::string>;

  fiber::World world_;
  ObjectTracks tracks_;
  RobotLinks links_;
  std::map<std::string, FramePose> poses_;
};

TEST_F(RobotLinksTest, LinksAreWhereTfHasThem) {
  EXPECT_EQ(unknown().size(), 2U);
  put("base", 1.0, 10.0);
  put("hand", 2.0, 10.0);
  EXPECT_TRUE(update(10.0));
  EXPECT_EQ(places(), (Places{{"robot/base", 1.0}, {"robot/hand", 2.0}}));
  EXPECT_EQ(unknown(), Strings());
  put("hand", 3.0, 10.5);
  EXPECT_TRUE(update(10.5));
  EXPECT_EQ(places(), (Places{{"robot/base", 1.0}, {"robot/hand", 3.0}}));
}

TEST_F(RobotLinksTest, ARobotAtRestChangesNothing) {
  put("base", 1.0, 10.0);
  put("hand", 2.0, 10.0);
  EXPECT_TRUE(update(10.0));
  const auto before = world_.environment();
  EXPECT_FALSE(update(10.5));
  EXPECT_EQ(world_.environment(), before);
}

TEST_F(RobotLinksTest, ALinkWithoutTransformIsUnknownAndTheRestGoesOn) {
  put("base", 1.0, 10.0);
  EXPECT_TRUE(update(10.0));
  EXPECT_EQ(places(), (Places{{"robot/base", 1.0}}));
  ASSERT_EQ(unknown().size(), 1U);
  EXPECT_EQ(unknown()[0].rfind("robot/hand since ", 0), 0U);
  EXPECT_NE(unknown()[0].find(": no transform of hand"), std::string::npos);
  put("hand", 2.0, 10.0);
  EXPECT_TRUE(update(10.0));
  EXPECT_EQ(unknown(), Strings());
  poses_.erase("base");
  EXPECT_TRUE(update(10.0));
  EXPECT_EQ(places(), (Places{{"robot/hand", 2.0}}));
  EXPECT_EQ(unknown(), (Strings{"robot/base since 10.000000000: no transform of base"}));
  put("base", 1.0, 10.0);  // where it was: it must come back all the same
  EXPECT_TRUE(update(10.0));
  EXPECT_EQ(places(), (Places{{"robot/base", 1.0}, {"robot/hand", 2.0}}));
}

TEST_F(RobotLinksTest, AnOldTransformIsNoneUnlessItIsStatic) {
  put("base", 1.0, 0.0);
  put("hand", 2.0, 10.0);
  EXPECT_TRUE(update(11.0));
  EXPECT_EQ(places().size(), 2U);
  EXPECT_TRUE(update(11.5));
  EXPECT_EQ(places(), (Places{{"robot/base", 1.0}}));
  EXPECT_EQ(unknown(), (Strings{"robot/hand since 10.000000000: its transform is of 10.000000000, "
                                "older than 1 s (robot_timeout)"}));
}

TEST_F(RobotLinksTest, APoseThatIsNoneMakesItsLinkUnknown) {
  put("base", 1.0, 10.0);
  put("hand", std::numeric_limits<double>::infinity(), 10.0);
  EXPECT_TRUE(update(10.0));
  EXPECT_EQ(places(), (Places{{"robot/base", 1.0}}));
  EXPECT_EQ(unknown().size(), 1U);
}

}  // namespace
}  // namespace fiber_proximity_ros
