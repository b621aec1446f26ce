// Markers as obstacles, through the real graph.
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "test/ros/environment_fixture.hpp"
#include "test/ros/gate.hpp"
#include "test/ros/mesh_files.hpp"

namespace environment_test {
namespace {

using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

class ObstacleMarkersTest : public EnvironmentFixture {
 protected:
  void start_with_topic() {
    own.setParam("obstacle_markers", own.resolveName("bodies"));
    start();
    publisher_ = advertise<MarkerArray>("bodies");
  }

  static Marker marker(std::int32_t type, std::int32_t id, double x = 0.0) {
    Marker marker;
    marker.header = test_messages::header("world");
    marker.ns = "bodies";
    marker.id = id;
    marker.type = type;
    marker.pose.position.x = x;
    marker.scale.x = 1.0;
    marker.scale.y = 1.0;
    marker.scale.z = 1.0;
    return marker;
  }

  static Marker action(std::int32_t action, std::int32_t id) {
    Marker marker = ObstacleMarkersTest::marker(Marker::CUBE, id);
    marker.action = action;
    return marker;
  }

  void publish(const std::vector<Marker>& markers) {
    MarkerArray message;
    message.markers = markers;
    publisher_.publish(message);
    ++published_;
    ASSERT_TRUE(wait_for([&] {
      return statistics_of(own.resolveName("bodies")).received == published_ &&
             !inputs->is_waiting();
    }));
  }

  fiber_proximity::InputStatistics statistics() const {
    return statistics_of(own.resolveName("bodies"));
  }

  ros::Publisher publisher_;
  std::uint64_t published_ = 0;
};

TEST_F(ObstacleMarkersTest, EveryTypeOfBodyIsItself) {
  const test_meshes::Package package;
  start_with_topic();
  Marker cube = marker(Marker::CUBE, 0, 1.0);
  cube.scale.y = 2.0;
  Marker cylinder = marker(Marker::CYLINDER, 2);
  cylinder.scale.z = 3.0;
  Marker cubes = marker(Marker::CUBE_LIST, 3);
  cubes.points.resize(2);
  cubes.points[1].y = 4.0;
  Marker balls = marker(Marker::SPHERE_LIST, 4);
  balls.points.resize(3);
  Marker triangles = marker(Marker::TRIANGLE_LIST, 5);
  triangles.points.resize(3);
  triangles.points[1].x = 1.0;
  triangles.points[2].y = 1.0;
  Marker mesh = marker(Marker::MESH_RESOURCE, 6);
  mesh.mesh_resource = "package://test_meshes/meshes/tetrahedron.obj";
  publish({cube, marker(Marker::SPHERE, 1), cylinder, cubes, balls, triangles, mesh,
           marker(Marker::TEXT_VIEW_FACING, 7)});
  EXPECT_EQ(statistics().refused, 0U) << statistics().last_error;
  const auto environment = inputs->environment();
  const auto& objects = environment->objects();
  ASSERT_EQ(objects.size(), 7U);
  EXPECT_EQ(objects[0].name, "bodies/0");
  EXPECT_EQ(objects[0].pose.translation().x(), 1.0);
  EXPECT_EQ(std::get<fiber::BoxShape>(objects[0].shapes[0].shape).size, Eigen::Vector3d(1, 2, 1));
  EXPECT_EQ(std::get<fiber::SphereShape>(objects[1].shapes[0].shape).radius, 0.5);
  EXPECT_EQ(std::get<fiber::CylinderShape>(objects[2].shapes[0].shape).radius, 0.5);
  EXPECT_EQ(std::get<fiber::CylinderShape>(objects[2].shapes[0].shape).height, 3.0);
  ASSERT_EQ(objects[3].shapes.size(), 2U);
  EXPECT_EQ(objects[3].shapes[1].pose.translation(), Eigen::Vector3d(0, 4, 0));
  EXPECT_EQ(objects[4].shapes.size(), 3U);
  const auto mesh_of = [&](std::size_t i) {
    return std::get<std::shared_ptr<const fiber::TriangleMesh>>(objects[i].shapes[0].shape);
  };
  EXPECT_EQ(mesh_of(5)->triangles().size(), 1U);
  EXPECT_EQ(mesh_of(6)->triangles().size(), 4U);
  // The mesh is not read again.
  const auto before = mesh_of(6);
  mesh.pose.position.x = 5.0;
  publish({mesh});
  EXPECT_EQ(places().at("bodies/6"), 5.0);
  EXPECT_EQ(std::get<std::shared_ptr<const fiber::TriangleMesh>>(
                inputs->environment()->objects()[6].shapes[0].shape),
            before);
}

TEST_F(ObstacleMarkersTest, WhileAMeshIsBuiltEverythingElseGoesOn) {
  const test_meshes::Package package;
  start_with_topic();
  Marker triangles = marker(Marker::TRIANGLE_LIST, 0, 1.0);
  for (int i = 0; i < 600; ++i) {
    for (const auto& [y, z] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}}) {
      triangles.points.emplace_back();
      triangles.points.back().x = 0.01 * i;
      triangles.points.back().y = y;
      triangles.points.back().z = z;
    }
  }
  Marker file = marker(Marker::MESH_RESOURCE, 1, 2.0);
  file.mesh_resource = "package://test_meshes/meshes/tetrahedron.obj";
  Gate gate(inputs->mesh_builder());
  const auto send = [this](const Marker& marker) {
    MarkerArray message;
    message.markers = {marker};
    publisher_.publish(message);
  };
  send(triangles);
  send(file);
  send(marker(Marker::CUBE, 2, 3.0));
  ASSERT_TRUE(wait_for([&] { return places() == Places{{"bodies/2", 3.0}}; }));
  EXPECT_TRUE(inputs->is_waiting());
  gate.open();
  ASSERT_TRUE(wait_for([&] { return !inputs->is_waiting(); }));
  EXPECT_EQ(places(), (Places{{"bodies/0", 1.0}, {"bodies/1", 2.0}, {"bodies/2", 3.0}}));
  EXPECT_EQ(statistics().refused, 0U) << statistics().last_error;
}

TEST_F(ObstacleMarkersTest, MarkersAreDeletedAsInRviz) {
  start_with_topic();
  publish({marker(Marker::CUBE, 0), marker(Marker::CUBE, 1), marker(Marker::CUBE, 2)});
  publish({action(Marker::DELETE, 1), action(Marker::DELETE, 9)});
  EXPECT_EQ(places(), (Places{{"bodies/0", 0.0}, {"bodies/2", 0.0}}));
  EXPECT_EQ(apply({ball("ball"), removal("bodies/0")}), "");
  publish({action(Marker::DELETE, 0)});
  publish({action(Marker::DELETEALL, 0), marker(Marker::CUBE, 4, 4.0)});
  EXPECT_EQ(places(), (Places{{"ball", 0.0}, {"bodies/4", 4.0}}));
  EXPECT_EQ(statistics().refused, 0U) << statistics().last_error;
}

TEST_F(ObstacleMarkersTest, ALifetimeEnds) {
  start_with_topic();
  Marker brief = marker(Marker::CUBE, 0);
  brief.lifetime = ros::Duration(0.1);
  publish({brief, marker(Marker::CUBE, 1)});
  EXPECT_TRUE(wait_for([&] { return places() == Places{{"bodies/1", 0.0}}; }));
}

TEST_F(ObstacleMarkersTest, ALifetimeGoesOnWhenTimeGoesBack) {
  start_with_topic();
  const ros::Time begin = ros::Time::now();
  ros::Time::setNow(begin);
  Marker brief = marker(Marker::CUBE, 1);
  brief.lifetime = ros::Duration(2.0);
  publish({brief});
  const auto is_there_at = [&](double seconds) {
    ros::Time::setNow(begin + ros::Duration(seconds));
    inputs->update(ros::Time::now());
    return places().size() == 1;
  };
  EXPECT_TRUE(is_there_at(1.9));
  EXPECT_TRUE(is_there_at(-1000.0));
  EXPECT_TRUE(is_there_at(-999.95));
  EXPECT_FALSE(is_there_at(-999.85));
  ros::Time::init();  // the clock of the machine again
}

/// rviz has them move with it; what does not would be told to be where it is not.
TEST_F(ObstacleMarkersTest, MarkersThatFollowAFrameAreRefused) {
  start_with_topic();
  static_transforms.sendTransform(transform("hand", 3.0));
  Marker locked = marker(Marker::CUBE, 1);
  locked.frame_locked = 1;
  publish({locked});
  EXPECT_EQ(places().size(), 1U) << "the fixed frame stays where it is";
  locked.id = 2;
  locked.header.frame_id = "hand";
  publish({locked});
  EXPECT_EQ(places().size(), 1U);
  EXPECT_EQ(statistics().last_error,
            "marker 'bodies/2': frame_locked is true in frame 'hand', it must be false there: "
            "obstacles do not follow a frame");
  EXPECT_EQ(unknown().size(), 1U);
}

TEST_F(ObstacleMarkersTest, DoNotTakeThePlaceOfOthersObstacles) {
  own.setParam("obstacle_markers",
               std::vector<std::string>{own.resolveName("bodies"), own.resolveName("others")});
  start();
  publisher_ = advertise<MarkerArray>("bodies");
  const ros::Publisher others = advertise<MarkerArray>("others");
  EXPECT_EQ(apply({ball("bodies/7", 7.0)}), "");
  publish({marker(Marker::CUBE, 1, 1.0)});
  MarkerArray message;
  message.markers = {marker(Marker::CUBE, 1, 5.0)};
  others.publish(message);
  ASSERT_TRUE(wait_for([&] { return statistics_of("others").refused == 1; }));
  EXPECT_EQ(statistics_of("others").last_error, "obstacle 'bodies/1' is there already, from '" +
                                                    own.resolveName("bodies") +
                                                    "': its name must be another one");
  publish({marker(Marker::CUBE, 7, 5.0)});
  EXPECT_EQ(statistics().last_error,
            "obstacle 'bodies/7' is there already, from the scene or ~obstacles: its name must be "
            "another one");
  EXPECT_NE(apply({ball("bodies/1", 5.0)}), "");
  EXPECT_EQ(places(), (Places{{"bodies/1", 1.0}, {"bodies/7", 7.0}}));
  // Each deletes its own only.
  message.markers = {action(Marker::DELETEALL, 0)};
  others.publish(message);
  ASSERT_TRUE(wait_for([&] { return statistics_of("others").received == 2; }));
  EXPECT_EQ(places().size(), 2U);
  publish({action(Marker::DELETEALL, 0)});
  EXPECT_EQ(places(), (Places{{"bodies/7", 7.0}}));
}

TEST_F(ObstacleMarkersTest, ABadMarkerIsNamedAndItsMessageChangesNothing) {
  start_with_topic();
  std::uint64_t refused = 0;
  const auto expect_refusal = [&](const Marker& bad, const std::string& reason) {
    publish({marker(Marker::CUBE, 0), bad});
    EXPECT_EQ(statistics().refused, ++refused);
    EXPECT_EQ(statistics().last_error.rfind("marker 'bodies/1': ", 0), 0U)
        << statistics().last_error;
    EXPECT_NE(statistics().last_error.find(reason), std::string::npos) << statistics().last_error;
    EXPECT_EQ(places(), Places());
  };
  Marker bad = marker(Marker::SPHERE, 1);
  bad.scale.z = 2.0;
  expect_refusal(bad, "of a sphere they must be the same");
  bad = marker(Marker::CYLINDER, 1);
  bad.scale.y = 2.0;
  expect_refusal(bad, "of a cylinder they must be the same");
  bad = marker(Marker::CUBE, 1);
  bad.scale.x = -1.0;
  expect_refusal(bad, "-1");
  bad = marker(Marker::CUBE, 1);
  bad.lifetime = ros::Duration(-5.0);
  expect_refusal(bad, "lifetime is -5.000000 s, it must be at least 0");
  bad = marker(Marker::CUBE, 1);
  bad.action = 9;
  expect_refusal(bad, "action is 9");
  bad = marker(Marker::CUBE, 1);
  bad.pose.orientation.x = 3.0;
  expect_refusal(bad, "quaternion");
  bad = marker(Marker::CUBE, 1);
  bad.action = 7;
  expect_refusal(bad, "action is 7");
  bad = marker(Marker::TRIANGLE_LIST, 1);
  bad.points.resize(4);
  expect_refusal(bad, "TRIANGLE_LIST of 4 points");
  bad = marker(Marker::MESH_RESOURCE, 1);
  bad.mesh_resource = "file:///etc/passwd";
  expect_refusal(bad, "mesh_folders");
  bad = marker(Marker::CUBE_LIST, 1);
  expect_refusal(bad, "shape");
}

}  // namespace
}  // namespace environment_test
