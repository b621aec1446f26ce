#include "src/ros/environment/robot_description.hpp"

#include <urdf/model.h>

#include <stdexcept>

#include "src/environment/obstacle_parts.hpp"

namespace fiber_proximity_ros {
namespace {

Eigen::Isometry3d to_isometry(const urdf::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y,
                                    pose.rotation.z);
  return Eigen::Translation3d(pose.position.x, pose.position.y, pose.position.z) *
         rotation.normalized();
}

Eigen::Vector3d to_eigen(const urdf::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

fiber::Shape shape_of(const urdf::Geometry& geometry, const MeshLoader& meshes) {
  switch (geometry.type) {
    case urdf::Geometry::BOX:
      return fiber::BoxShape{to_eigen(dynamic_cast<const urdf::Box&>(geometry).dim)};
    case urdf::Geometry::SPHERE:
      return fiber::SphereShape{dynamic_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
      return fiber::CylinderShape{cylinder.radius, cylinder.length};
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = dynamic_cast<const urdf::Mesh&>(geometry);
      return meshes(mesh.filename, to_eigen(mesh.scale));
    }
    default:
      throw std::invalid_argument("its geometry must be a box, sphere, cylinder or mesh");
  }
}

fiber::PlacedShape to_placed_shape(const urdf::Collision& collision, const MeshLoader& meshes) {
  if (collision.geometry == nullptr) {
    throw std::invalid_argument("it has no geometry");
  }
  return {shape_of(*collision.geometry, meshes), to_isometry(collision.origin)};
}

RobotLink read_link(const urdf::Link& link, const MeshLoader& meshes) {
  RobotLink read;
  read.frame = link.name;
  read.object.name = fiber::robot_prefix + link.name;
  for (std::size_t i = 0; i < link.collision_array.size(); ++i) {
    fiber::with_context("link '" + link.name + "', collision " + std::to_string(i), [&] {
      read.object.shapes.push_back(to_placed_shape(*link.collision_array[i], meshes));
    });
  }
  fiber::validate(read.object);
  return read;
}

}  // namespace

std::vector<RobotLink> read_robot(const std::string& description, const MeshLoader& meshes) {
  urdf::Model model;
  if (!model.initString(description)) {
    throw std::invalid_argument("the robot's description is no URDF of a robot (see the log)");
  }
  std::vector<RobotLink> links;
  for (const auto& [name, link] : model.links_) {
    if (!link->collision_array.empty()) {
      links.push_back(read_link(*link, meshes));
    }
  }
  if (links.empty()) {
    throw std::invalid_argument("the robot '" + model.getName() +
                                "' has no collision geometry, it needs that of 1 link at least");
  }
  return links;
}

}  // namespace fiber_proximity_ros
