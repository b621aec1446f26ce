// MoveIt's messages, through moveit_bridge, in the running node's environment.
#include "src/ros/bridges/moveit_bridge.hpp"

#include <ros/spinner.h>

#include <mutex>

#include "test/ros/bridge_fixture.hpp"
#include "test/support/not_finite.hpp"

namespace {

using bridge_test::Distances;
using fiber_proximity::ApplyObstacles;
using fiber_proximity_ros::MoveitBridge;
using moveit_msgs::CollisionObject;
using moveit_msgs::PlanningScene;

using fiber::test::nan;

CollisionObject change(const std::string& id, std::int8_t operation, double x = 0.0) {
  CollisionObject object;
  object.header = test_messages::header("world", ros::Time::now());
  object.id = id;
  object.operation = operation;
  object.pose.position.x = x;
  object.pose.orientation.w = 1.0;
  return object;
}

/// A ball of 0.25 m at x.
CollisionObject ball(const std::string& id, double x,
                     std::int8_t operation = CollisionObject::ADD) {
  CollisionObject object = change(id, operation, x);
  object.primitives.resize(1);
  object.primitives[0].type = shape_msgs::SolidPrimitive::SPHERE;
  object.primitives[0].dimensions = {0.25};
  return object;
}

class MoveitBridgeTest : public bridge_test::BridgeTest {
 protected:
  void SetUp() override {
    BridgeTest::SetUp();
    objects_ = advertise<CollisionObject>("collision_object");
    scenes_ = advertise<PlanningScene>("planning_scene");
    publish_scene({}, false);
    expect_distances({});
  }

  void publish_scene(const std::vector<CollisionObject>& objects, bool is_diff) {
    PlanningScene scene;
    scene.world.collision_objects = objects;
    scene.is_diff = is_diff ? 1 : 0;
    scenes_.publish(scene);
  }

  ros::Publisher objects_;
  ros::Publisher scenes_;
};

TEST_F(MoveitBridgeTest, ObjectsAreAddedAppendedToMovedAndRemoved) {
  objects_.publish(ball("ball", 1.0));
  expect_distances({{"ball", {0.75}}});
  CollisionObject more = ball("ball", 0.0, CollisionObject::APPEND);
  more.primitive_poses.resize(1);
  more.primitive_poses[0].position.x = 2.0;  // from the object, which stays
  more.primitive_poses[0].orientation.w = 1.0;
  objects_.publish(more);
  expect_distances({{"ball", {0.75, 2.75}}});
  objects_.publish(change("ball", CollisionObject::MOVE, 2.0));
  expect_distances({{"ball", {1.75, 3.75}}});
  CollisionObject floor = change("floor", CollisionObject::ADD);
  floor.planes.resize(1);
  floor.planes[0].coef = {0.0, 0.0, 1.0, 0.5};
  floor.meshes.resize(1);
  floor.meshes[0].vertices.resize(3);
  for (auto& vertex : floor.meshes[0].vertices) {
    vertex.y = 4.0;
  }
  floor.meshes[0].vertices[1].x = 1.0;
  floor.meshes[0].vertices[2].z = 1.0;
  floor.meshes[0].triangles.resize(1);
  floor.meshes[0].triangles[0].vertex_indices = {0, 1, 2};
  objects_.publish(floor);
  expect_distances({{"ball", {1.75, 3.75}}, {"floor", {0.5, 4.0}}});
  objects_.publish(change("ball", CollisionObject::REMOVE));
  expect_distances({{"floor", {0.5, 4.0}}});
}

TEST_F(MoveitBridgeTest, FibresTouchTheObjects) {
  node_test::Recorder<fiber_proximity::ContactArray> environment(node,
                                                                 "/proximity/environment_contacts");
  objects_.publish(ball("ball", 0.5));
  expect_distances({{"ball", {0.25}}});
  connect(publisher_, fiber(), [&] { return !environment.messages.empty(); });
  const fiber_proximity::ContactArray& answer = *environment.messages.back();
  EXPECT_EQ(answer.object_names, std::vector<std::string>{"ball"});
  ASSERT_EQ(answer.contacts.size(), 1U);
  EXPECT_NEAR(answer.contacts[0].distance, -0.26, 1e-12);
}

TEST_F(MoveitBridgeTest, AFullSceneIsAllThereIsADifferenceComesOnTop) {
  objects_.publish(ball("first", 1.0));
  publish_scene({ball("second", 2.0), ball("third", 3.0)}, true);
  expect_distances({{"first", {0.75}}, {"second", {1.75}}, {"third", {2.75}}});
  publish_scene({ball("fourth", 4.0)}, false);
  expect_distances({{"fourth", {3.75}}});
  publish_scene({change("fourth", CollisionObject::REMOVE), ball("fifth", 5.0)}, true);
  expect_distances({{"fifth", {4.75}}});
}

TEST_F(MoveitBridgeTest, AMessageIsAppliedAsAWholeOrNotAtAll) {
  objects_.publish(ball("good", 1.0));
  CollisionObject unknown = ball("strange", 2.0);
  unknown.primitives[0].type = 9;
  publish_scene({ball("other", 3.0), unknown}, false);
  expect_log(
      "'/planning_scene': message refused by /proximity/apply_obstacles: obstacle 'strange': "
      "primitive 0: type is 9");
  objects_.publish(unknown);
  expect_log(
      "'/collision_object': message refused by /proximity/apply_obstacles: obstacle "
      "'strange': primitive 0: type is 9");
  CollisionObject mesh = change("mesh", CollisionObject::ADD);
  mesh.meshes.resize(1);
  mesh.meshes[0].vertices.resize(3);
  mesh.meshes[0].vertices[1].y = nan;
  mesh.meshes[0].triangles.resize(1);
  mesh.meshes[0].triangles[0].vertex_indices = {0, 1, 2};
  objects_.publish(mesh);
  expect_log("obstacle 'mesh': mesh 0: vertex 1");
  objects_.publish(ball("lost", nan));
  expect_log("obstacle 'lost': pose: position (nan, 0, 0) is not finite");
  objects_.publish(change("nobody", CollisionObject::REMOVE));
  expect_log("'nobody'");
  CollisionObject elsewhere = ball("elsewhere", 1.0);
  elsewhere.header.frame_id = "moon";
  objects_.publish(elsewhere);
  expect_log("obstacle 'elsewhere': no transform from frame 'moon'");
  expect_distances({{"good", {0.75}}});
}

TEST_F(MoveitBridgeTest, SaysOnceWhatHasNoCounterpart) {
  CollisionObject object = ball("cup", 1.0);
  object.subframe_names = {"handle"};
  object.subframe_poses.resize(1);
  objects_.publish(object);
  PlanningScene scene;
  scene.is_diff = 1;
  scene.world.collision_objects = {object};
  scene.robot_state.attached_collision_objects.resize(1);
  scenes_.publish(scene);
  scene.world.collision_objects[0].pose.position.x = 2.0;
  scenes_.publish(scene);
  expect_distances({{"cup", {1.75}}});
  const std::string rest = " have no counterpart and are left out, here and from now on";
  expect_log("'/collision_object': subframes of objects" + rest);
  expect_log("'/planning_scene': objects attached to the robot" + rest);
  EXPECT_EQ(logs_of("subframes of objects" + rest).size(), 1U);
  EXPECT_EQ(logs_of("objects attached to the robot" + rest).size(), 1U);
}

TEST_F(MoveitBridgeTest, PassesOnTheOctomapOfAScene) {
  const node_test::Recorder<octomap_msgs::Octomap> maps(node, "/octomap");
  PlanningScene scene;
  scene.is_diff = 1;
  octomap_msgs::OctomapWithPose& octomap = scene.world.octomap;
  octomap.header = test_messages::header("world");
  octomap.octomap.id = "OcTree";
  octomap.octomap.resolution = 0.25;
  octomap.octomap.data = {2, 0};
  scenes_.publish(scene);
  ASSERT_TRUE(node_test::wait_for([&] { return maps.messages.size() == 1; }));
  EXPECT_EQ(maps.messages[0]->header.frame_id, "world");
  EXPECT_EQ(maps.messages[0]->resolution, 0.25);
  EXPECT_EQ(maps.messages[0]->data, octomap.octomap.data);
  octomap = {};
  scenes_.publish(scene);  // a difference: the map is as before
  publish_scene({ball("after", 1.0)}, true);
  expect_distances({{"after", {0.75}}});
  EXPECT_EQ(maps.messages.size(), 1U);
  scene.is_diff = 0;
  scenes_.publish(scene);  // no map
  scenes_.publish(scene);  // still none
  ASSERT_TRUE(node_test::wait_for([&] { return maps.messages.size() == 2; }));
  EXPECT_EQ(maps.messages[1]->header.frame_id, "world");
  EXPECT_EQ(maps.messages[1]->id, "OcTree");
  EXPECT_TRUE(maps.messages[1]->data.empty());
  publish_scene({ball("end", 1.0)}, false);
  expect_distances({{"end", {0.75}}});
  EXPECT_EQ(maps.messages.size(), 2U);
}

/// A bridge of the test's own whose service is not there yet.
class WaitingBridgeTest : public node_test::NodeTest {
 protected:
  WaitingBridgeTest() { publisher_ = advertise<CollisionObject>("late/collision_object"); }

  void publish(std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      publisher_.publish(ball(std::to_string(i), 0.0));
    }
  }

  /// From now on there is a service, in another thread, as the bridge's calls block this one.
  void serve() {
    late_.setCallbackQueue(&queue_);
    const boost::function<bool(ApplyObstacles::Request&, ApplyObstacles::Response&)> apply =
        [this](ApplyObstacles::Request& request, ApplyObstacles::Response& response) {
          const std::lock_guard<std::mutex> lock(mutex_);
          for (const fiber_proximity::Obstacle& obstacle : request.obstacles) {
            names_.push_back(obstacle.id);
          }
          response.success = 1;
          return true;
        };
    server_ = late_.advertiseService("proximity/apply_obstacles", apply);
    spinner_.start();
  }

  void expect_applied(std::size_t count) {
    const auto applied = [this] {
      const std::lock_guard<std::mutex> lock(mutex_);
      return names_;
    };
    ASSERT_TRUE(node_test::wait_for([&] { return applied().size() >= count; }));
    const std::vector<std::string> names = applied();
    ASSERT_EQ(names.size(), count);
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(names[i], std::to_string(i));
    }
  }

 private:
  ros::NodeHandle late_{"late"};
  std::mutex mutex_;
  std::vector<std::string> names_;
  ros::CallbackQueue queue_;
  ros::AsyncSpinner spinner_{1, &queue_};
  ros::ServiceServer server_;
  MoveitBridge bridge_{ros::NodeHandle("late")};
  ros::Publisher publisher_;
};

TEST_F(WaitingBridgeTest, KeepsWhatComesUntilTheServiceIsThere) {
  publish(0, 3);
  ASSERT_TRUE(node_test::wait_for([&] {
    return !logs_of("message(s) wait for the service /late/proximity/apply_obstacles").empty();
  }));
  serve();
  expect_applied(3);
  publish(3, 5);
  expect_applied(5);
}

TEST_F(WaitingBridgeTest, SaysWhichMessagesItCannotKeep) {
  publish(0, MoveitBridge::max_waiting + 2);
  const std::string lost =
      "'/late/collision_object': message lost, as 1000 wait for the service "
      "/late/proximity/apply_obstacles already; its first object is ";
  ASSERT_TRUE(node_test::wait_for([&] { return logs_of(lost).size() == 2; }));
  EXPECT_EQ(logs_of(lost)[0], lost + "'1000'");
  EXPECT_EQ(logs_of(lost)[1], lost + "'1001'");
}

}  // namespace
