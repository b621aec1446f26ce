#include <gtest/gtest.h>

#include <utility>

#include "src/ros/bridges/moveit_bridge.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::Obstacle;
using moveit_msgs::CollisionObject;
using moveit_msgs::PlanningScene;
using Names = std::vector<std::string>;

geometry_msgs::Pose pose(double x) {
  geometry_msgs::Pose pose;
  pose.position.x = x;
  pose.orientation.w = 1.0;
  return pose;
}

/// With one or two of everything, all of them different.
CollisionObject object() {
  CollisionObject object;
  object.header.frame_id = "base";
  object.header.stamp = ros::Time(5, 6);
  object.pose = pose(1.0);
  object.id = "table";
  object.primitives.resize(2);
  object.primitives[1].type = shape_msgs::SolidPrimitive::CONE;
  object.primitives[1].dimensions = {0.25, 0.5};
  object.primitive_poses = {pose(2.0), pose(3.0)};
  object.meshes.resize(1);
  object.meshes[0].vertices.resize(3);
  object.meshes[0].triangles.resize(2);
  object.mesh_poses = {pose(4.0)};
  object.planes.resize(1);
  object.planes[0].coef = {1.0, 2.0, 3.0, 4.0};
  object.plane_poses = {pose(5.0)};
  return object;
}

TEST(CollisionObject, BecomesTheObstacleOfTheSameFields) {
  const CollisionObject object = fiber_proximity_ros::object();
  const Obstacle obstacle = to_obstacle(object);
  EXPECT_EQ(obstacle.header.frame_id, "base");
  EXPECT_TRUE(obstacle.header.stamp.isZero());
  EXPECT_EQ(obstacle.pose, object.pose);
  EXPECT_EQ(obstacle.id, "table");
  EXPECT_EQ(obstacle.primitives, object.primitives);
  EXPECT_EQ(obstacle.primitive_poses, object.primitive_poses);
  EXPECT_EQ(obstacle.meshes, object.meshes);
  EXPECT_EQ(obstacle.mesh_poses, object.mesh_poses);
  EXPECT_EQ(obstacle.planes, object.planes);
  EXPECT_EQ(obstacle.plane_poses, object.plane_poses);
  EXPECT_TRUE(obstacle.capsules.empty());
  EXPECT_TRUE(obstacle.half_spaces.empty());
}

TEST(CollisionObject, KeepsItsOperation) {
  CollisionObject object = fiber_proximity_ros::object();
  for (const auto& [theirs, ours] : {std::pair(CollisionObject::ADD, Obstacle::ADD),
                                     std::pair(CollisionObject::REMOVE, Obstacle::REMOVE),
                                     std::pair(CollisionObject::APPEND, Obstacle::APPEND),
                                     std::pair(CollisionObject::MOVE, Obstacle::MOVE)}) {
    object.operation = static_cast<std::int8_t>(theirs);
    EXPECT_EQ(to_obstacle(object).operation, ours);
  }
  object.operation = 7;  // refused where it is applied
  EXPECT_EQ(to_obstacle(object).operation, 7);
}

TEST(PlanningScene, ReplacesAllObstaclesUnlessItIsADifference) {
  PlanningScene scene;
  scene.world.collision_objects = {object(), object()};
  scene.world.collision_objects[1].id = "chair";
  scene.is_diff = 1;
  std::vector<Obstacle> obstacles = to_obstacles(scene);
  ASSERT_EQ(obstacles.size(), 2U);
  EXPECT_EQ(obstacles[0].id, "table");
  EXPECT_EQ(obstacles[1].id, "chair");
  scene.is_diff = 0;
  obstacles = to_obstacles(scene);
  ASSERT_EQ(obstacles.size(), 3U);
  EXPECT_EQ(obstacles[0].id, "");
  EXPECT_EQ(obstacles[0].operation, Obstacle::REMOVE);
  EXPECT_EQ(obstacles[1].id, "table");
  scene.world.collision_objects.clear();
  EXPECT_EQ(to_obstacles(scene).size(), 1U);
  scene.is_diff = 1;
  EXPECT_TRUE(to_obstacles(scene).empty());
}

TEST(PlanningScene, HasAnOctomapInItsOwnFrame) {
  PlanningScene scene;
  EXPECT_FALSE(octomap_of(scene));
  octomap_msgs::OctomapWithPose& placed = scene.world.octomap;
  placed.header.frame_id = "world";
  placed.octomap.id = "OcTree";
  placed.octomap.resolution = 0.25;
  placed.octomap.data = {1, 2};
  auto map = octomap_of(scene);
  ASSERT_TRUE(map);
  EXPECT_EQ(map->header.frame_id, "world");
  EXPECT_EQ(map->id, "OcTree");
  EXPECT_EQ(map->resolution, 0.25);
  EXPECT_EQ(map->data, placed.octomap.data);
  placed.origin = pose(0.0);
  EXPECT_TRUE(octomap_of(scene));
  EXPECT_EQ(without_counterpart(scene), Names());
  for (int i = 0; i < 6; ++i) {
    geometry_msgs::Pose origin = pose(0.0);
    double* const fields[] = {&origin.position.x,    &origin.position.y,    &origin.position.z,
                              &origin.orientation.x, &origin.orientation.y, &origin.orientation.z};
    *fields[i] = 0.5;
    placed.origin = origin;
    EXPECT_FALSE(octomap_of(scene)) << i;
    EXPECT_EQ(without_counterpart(scene), Names({"octomaps with a displaced origin"}));
  }
}

TEST(PlanningScene, TellsWhatHasNoCounterpart) {
  CollisionObject object = fiber_proximity_ros::object();
  EXPECT_EQ(without_counterpart(object), Names());
  PlanningScene scene;
  scene.link_padding.resize(2);
  scene.link_scale.resize(1);
  scene.link_scale[0].scale = 1.0;
  scene.world.collision_objects = {object, object};
  EXPECT_EQ(without_counterpart(scene), Names());

  object.subframe_names = {"handle"};
  object.subframe_poses.resize(1);
  EXPECT_EQ(without_counterpart(object), Names({"subframes of objects"}));
  scene.world.collision_objects[1] = object;
  scene.robot_state.attached_collision_objects.resize(1);
  scene.link_padding[1].padding = 0.01;
  EXPECT_EQ(without_counterpart(scene),
            Names({"objects attached to the robot", "padding and scale of links",
                   "subframes of objects"}));
  scene.link_padding[1].padding = 0.0;
  scene.link_scale[0].scale = 1.1;
  EXPECT_EQ(without_counterpart(scene).at(1), "padding and scale of links");
}

}  // namespace
}  // namespace fiber_proximity_ros
