#include "src/ros/environment/obstacle_change.hpp"

#include <array>
#include <cassert>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/environment/obstacle_parts.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::Obstacle;
using shape_msgs::SolidPrimitive;

using Operation = fiber::ObjectChange::Operation;
using Mesh = std::shared_ptr<const fiber::TriangleMesh>;

// ---- from messages -----------------------------------------------------------------------------

Operation to_operation(const Obstacle& obstacle) {
  constexpr std::array by_number{Operation::ADD, Operation::REMOVE, Operation::APPEND,
                                 Operation::MOVE};
  const auto number = static_cast<std::uint8_t>(obstacle.operation);
  if (number >= by_number.size()) {
    throw std::invalid_argument("operation is " + std::to_string(obstacle.operation) +
                                ", it must be 0 (ADD), 1 (REMOVE), 2 (APPEND) or 3 (MOVE)");
  }
  return by_number[number];
}

fiber::Shape to_primitive(const SolidPrimitive& primitive) {
  using fiber::Primitive;
  constexpr std::array by_number{Primitive::BOX, Primitive::SPHERE, Primitive::CYLINDER,
                                 Primitive::CONE};
  const std::size_t number = std::size_t{primitive.type} - 1;
  if (number >= by_number.size()) {
    throw std::invalid_argument("type is " + std::to_string(primitive.type) +
                                ", it must be 1 (BOX), 2 (SPHERE), 3 (CYLINDER) or 4 (CONE)");
  }
  return fiber::make_primitive(by_number[number], primitive.dimensions);
}

fiber::Shape to_capsule(const fiber_proximity::Capsule& capsule) {
  return fiber::CapsuleShape{capsule.radius, capsule.length};
}

fiber::Shape to_mesh(const shape_msgs::Mesh& mesh) {
  std::vector<Eigen::Vector3d> vertices;
  vertices.reserve(mesh.vertices.size());
  for (const geometry_msgs::Point& vertex : mesh.vertices) {
    vertices.push_back(to_vector(vertex));
  }
  std::vector<fiber::TriangleMesh::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const shape_msgs::MeshTriangle& triangle : mesh.triangles) {
    triangles.push_back(
        {triangle.vertex_indices[0], triangle.vertex_indices[1], triangle.vertex_indices[2]});
  }
  return std::make_shared<const fiber::TriangleMesh>(std::move(vertices), std::move(triangles));
}

fiber::Shape to_plane(const shape_msgs::Plane& plane) {
  return fiber::make_plane(Eigen::Vector4d(plane.coef.data()));
}

fiber::Shape to_half_space(const shape_msgs::Plane& plane) {
  return fiber::make_half_space(Eigen::Vector4d(plane.coef.data()));
}

fiber::ObjectChange to_unnamed_change(const Obstacle& obstacle) {
  fiber::ObjectChange change;
  change.operation = to_operation(obstacle);
  if (!obstacle.id.empty() || change.operation != Operation::REMOVE) {
    fiber::validate_obstacle_name(obstacle.id);
  }
  change.object.name = obstacle.id;
  change.object.pose = fiber::with_context("pose", [&] { return to_pose(obstacle.pose); });
  const auto append = [&change](const auto& kind, const auto& shapes, const auto& poses,
                                const auto& to_shape) {
    fiber::append_shapes(kind, shapes, poses, to_shape, to_pose, change.object.shapes);
  };
  append("primitive", obstacle.primitives, obstacle.primitive_poses, to_primitive);
  append("capsule", obstacle.capsules, obstacle.capsule_poses, to_capsule);
  append("mesh", obstacle.meshes, obstacle.mesh_poses, to_mesh);
  append("plane", obstacle.planes, obstacle.plane_poses, to_plane);
  append("half-space", obstacle.half_spaces, obstacle.half_space_poses, to_half_space);
  return change;
}

// ---- to messages -------------------------------------------------------------------------------

shape_msgs::Plane plane_message(const Eigen::Vector3d& normal, double offset) {
  shape_msgs::Plane message;
  message.coef = {normal.x(), normal.y(), normal.z(), -offset};
  return message;
}

/// Adds a shape to the lists of its kind.
struct ShapeAdder {
  Obstacle& obstacle;
  geometry_msgs::Pose pose;

  void operator()(const fiber::BoxShape& box) const {
    add_primitive(SolidPrimitive::BOX, {box.size.x(), box.size.y(), box.size.z()});
  }
  void operator()(const fiber::SphereShape& sphere) const {
    add_primitive(SolidPrimitive::SPHERE, {sphere.radius});
  }
  void operator()(const fiber::CylinderShape& cylinder) const {
    add_primitive(SolidPrimitive::CYLINDER, {cylinder.height, cylinder.radius});
  }
  void operator()(const fiber::ConeShape& cone) const {
    add_primitive(SolidPrimitive::CONE, {cone.height, cone.radius});
  }
  void operator()(const fiber::CapsuleShape& capsule) const {
    fiber_proximity::Capsule message;
    message.radius = capsule.radius;
    message.length = capsule.length;
    add(message, obstacle.capsules, obstacle.capsule_poses);
  }
  void operator()(const fiber::HalfSpaceShape& half_space) const {
    add(plane_message(half_space.normal, half_space.offset), obstacle.half_spaces,
        obstacle.half_space_poses);
  }
  void operator()(const fiber::PlaneShape& plane) const {
    add(plane_message(plane.normal, plane.offset), obstacle.planes, obstacle.plane_poses);
  }
  void operator()(const Mesh& mesh) const {
    shape_msgs::Mesh message;
    for (const Eigen::Vector3d& vertex : mesh->vertices()) {
      message.vertices.push_back(to_message(vertex));
    }
    for (const fiber::TriangleMesh::Triangle& triangle : mesh->triangles()) {
      message.triangles.emplace_back();
      message.triangles.back().vertex_indices = {triangle[0], triangle[1], triangle[2]};
    }
    add(message, obstacle.meshes, obstacle.mesh_poses);
  }
  void operator()(const std::shared_ptr<const fiber::OccupancyOctree>& /*octree*/) const {
    assert(false && "octrees have no message");
  }

 private:
  template <class Message>
  void add(const Message& message, std::vector<Message>& list,
           std::vector<geometry_msgs::Pose>& poses) const {
    list.push_back(message);
    poses.push_back(pose);
  }
  void add_primitive(std::uint8_t type, const std::vector<double>& dimensions) const {
    SolidPrimitive message;
    message.type = type;
    message.dimensions = dimensions;
    add(message, obstacle.primitives, obstacle.primitive_poses);
  }
};

}  // namespace

Eigen::Isometry3d to_pose(const geometry_msgs::Pose& message) {
  const geometry_msgs::Quaternion& q = message.orientation;
  return fiber::make_pose(to_vector(message.position), Eigen::Quaterniond(q.w, q.x, q.y, q.z));
}

fiber::ObjectChange to_change(const Obstacle& obstacle) {
  fiber::ObjectChange change = fiber::with_context("obstacle " + fiber::quote(obstacle.id),
                                                   [&] { return to_unnamed_change(obstacle); });
  if (!change.object.name.empty()) {
    fiber::validate(change.object);
  }
  return change;
}

fiber::ObjectChange removal_of(const std::string& name) {
  fiber::ObjectChange removal;
  removal.operation = Operation::REMOVE;
  removal.object.name = name;
  return removal;
}

Obstacle to_obstacle(const fiber::EnvironmentObject& object, const std::string& frame_id) {
  Obstacle obstacle;
  obstacle.header.frame_id = frame_id;
  obstacle.id = object.name;
  obstacle.operation = Obstacle::ADD;
  obstacle.pose = to_message(object.pose);
  for (const fiber::PlacedShape& placed : object.shapes) {
    std::visit(ShapeAdder{obstacle, to_message(placed.pose)}, placed.shape);
  }
  return obstacle;
}

}  // namespace fiber_proximity_ros
