#include "fiber_proximity/ros/obstacle_shapes.hpp"

#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using shape_msgs::SolidPrimitive;

void require_dimensions(const SolidPrimitive& primitive, const std::string& type, std::size_t count,
                        const std::string& meaning) {
  if (primitive.dimensions.size() != count) {
    throw std::invalid_argument(
        "a " + type + " has " + std::to_string(primitive.dimensions.size()) +
        " dimension(s), it must have " + std::to_string(count) + ": " + meaning);
  }
}

fiber::Shape to_box(const SolidPrimitive& primitive) {
  require_dimensions(primitive, "box", 3, "x, y and z");
  return fiber::BoxShape{{primitive.dimensions[SolidPrimitive::BOX_X],
                          primitive.dimensions[SolidPrimitive::BOX_Y],
                          primitive.dimensions[SolidPrimitive::BOX_Z]}};
}

fiber::Shape to_sphere(const SolidPrimitive& primitive) {
  require_dimensions(primitive, "sphere", 1, "the radius");
  return fiber::SphereShape{primitive.dimensions[SolidPrimitive::SPHERE_RADIUS]};
}

fiber::Shape to_cylinder(const SolidPrimitive& primitive) {
  require_dimensions(primitive, "cylinder", 2, "height and radius");
  return fiber::CylinderShape{primitive.dimensions[SolidPrimitive::CYLINDER_RADIUS],
                              primitive.dimensions[SolidPrimitive::CYLINDER_HEIGHT]};
}

fiber::Shape to_cone(const SolidPrimitive& primitive) {
  require_dimensions(primitive, "cone", 2, "height and radius");
  return fiber::ConeShape{primitive.dimensions[SolidPrimitive::CONE_RADIUS],
                          primitive.dimensions[SolidPrimitive::CONE_HEIGHT]};
}

}  // namespace

fiber::Shape to_shape(const SolidPrimitive& primitive) {
  switch (primitive.type) {
    case SolidPrimitive::BOX:
      return to_box(primitive);
    case SolidPrimitive::SPHERE:
      return to_sphere(primitive);
    case SolidPrimitive::CYLINDER:
      return to_cylinder(primitive);
    case SolidPrimitive::CONE:
      return to_cone(primitive);
    default:
      throw std::invalid_argument("type is " + std::to_string(primitive.type) +
                                  ", it must be 1 (BOX), 2 (SPHERE), 3 (CYLINDER) or 4 (CONE)");
  }
}

fiber::Shape to_shape(const fiber_proximity::Capsule& capsule) {
  return fiber::CapsuleShape{capsule.radius, capsule.length};
}

fiber::Shape to_shape(const shape_msgs::Mesh& mesh) {
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

fiber::PlaneShape to_plane(const shape_msgs::Plane& plane) {
  const Eigen::Vector4d coefficients(plane.coef.data());
  const double length = coefficients.head<3>().stableNorm();
  if (!(length > 0.0 && coefficients.allFinite())) {
    std::ostringstream message;
    message << "coef is (" << coefficients[0] << ", " << coefficients[1] << ", " << coefficients[2]
            << ", " << coefficients[3]
            << "), it must be finite and its first three not all 0: ax + by + cz + d = 0";
    throw std::invalid_argument(message.str());
  }
  return {coefficients.head<3>() / length, -coefficients[3] / length};
}

fiber::HalfSpaceShape to_half_space(const shape_msgs::Plane& plane) {
  const fiber::PlaneShape boundary = to_plane(plane);
  return {boundary.normal, boundary.offset};
}

}  // namespace fiber_proximity_ros
