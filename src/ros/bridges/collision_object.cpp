#include "src/ros/bridges/collision_object.hpp"

namespace fiber_proximity_ros {

using fiber_proximity::Obstacle;
using moveit_msgs::CollisionObject;

static_assert(int{Obstacle::ADD} == int{CollisionObject::ADD} &&
              int{Obstacle::REMOVE} == int{CollisionObject::REMOVE} &&
              int{Obstacle::APPEND} == int{CollisionObject::APPEND} &&
              int{Obstacle::MOVE} == int{CollisionObject::MOVE});

Obstacle to_obstacle(const CollisionObject& object) {
  Obstacle obstacle;
  obstacle.header.frame_id = object.header.frame_id;
  obstacle.pose = object.pose;
  obstacle.id = object.id;
  obstacle.primitives = object.primitives;
  obstacle.primitive_poses = object.primitive_poses;
  obstacle.meshes = object.meshes;
  obstacle.mesh_poses = object.mesh_poses;
  obstacle.planes = object.planes;
  obstacle.plane_poses = object.plane_poses;
  obstacle.operation = object.operation;
  return obstacle;
}

}  // namespace fiber_proximity_ros
