#include "fiber_proximity/environment/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// How far from one the length of a unit vector and the determinant of a rotation may be.
constexpr double unit_tolerance = 1e-6;

[[noreturn]] void refuse(const std::string& what, double value, const std::string& rule) {
  std::ostringstream message;
  message << what << " is " << value << ", it must be " << rule;
  throw std::invalid_argument(message.str());
}

void check_length(const char* what, double length) {
  if (!FiberAssembly::is_valid_radius(length)) {
    refuse(what, length, "finite, at least 0 and at most 1e150 m");
  }
}

void check_sheet(const char* what, const Vector3d& normal, double offset) {
  if (!(std::abs(normal.norm() - 1.0) <= unit_tolerance)) {
    refuse(std::string("length of the ") + what + "'s normal", normal.norm(), "1");
  }
  if (!FiberAssembly::is_valid_coordinate(offset)) {
    refuse(std::string("offset of the ") + what, offset, "finite and at most 1e150 m in magnitude");
  }
}

struct Check {
  void operator()(const BoxShape& box) const {
    check_length("size of the box along axis 0", box.size[0]);
    check_length("size of the box along axis 1", box.size[1]);
    check_length("size of the box along axis 2", box.size[2]);
  }
  void operator()(const SphereShape& sphere) const {
    check_length("radius of the sphere", sphere.radius);
  }
  void operator()(const CylinderShape& cylinder) const {
    check_length("radius of the cylinder", cylinder.radius);
    check_length("height of the cylinder", cylinder.height);
  }
  void operator()(const ConeShape& cone) const {
    check_length("radius of the cone", cone.radius);
    check_length("height of the cone", cone.height);
  }
  void operator()(const CapsuleShape& capsule) const {
    check_length("radius of the capsule", capsule.radius);
    check_length("length of the capsule", capsule.length);
  }
  void operator()(const HalfSpaceShape& half_space) const {
    check_sheet("half-space", half_space.normal, half_space.offset);
  }
  void operator()(const PlaneShape& plane) const {
    check_sheet("plane", plane.normal, plane.offset);
  }
  template <class Shared>
  void operator()(const std::shared_ptr<const Shared>& shared) const {
    if (shared == nullptr) {
      throw std::invalid_argument("the shape is a null pointer");
    }
  }
};

struct Reach {
  double operator()(const BoxShape& box) const { return box.size.norm() / 2.0; }
  double operator()(const SphereShape& sphere) const { return sphere.radius; }
  double operator()(const CylinderShape& cylinder) const {
    return std::hypot(cylinder.radius, cylinder.height / 2.0);
  }
  double operator()(const ConeShape& cone) const {
    return std::hypot(cone.radius, cone.height / 2.0);
  }
  double operator()(const CapsuleShape& capsule) const {
    return capsule.radius + capsule.length / 2.0;
  }
  double operator()(const HalfSpaceShape& half_space) const { return std::abs(half_space.offset); }
  double operator()(const PlaneShape& plane) const { return std::abs(plane.offset); }
  template <class Shared>
  double operator()(const std::shared_ptr<const Shared>& shared) const {
    const WorldBox& box = shared->box();
    return box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs()).norm();
  }
};

/// Half the extents of a disc around an axis [m].
Vector3d disc_extents(const Vector3d& axis, double radius) {
  return radius * (Vector3d::Ones() - axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
}

/// Around the shape, relative to its origin, with this rotation.
struct RotatedBox {
  WorldBox operator()(const BoxShape& box) const {
    return symmetric(rotation.cwiseAbs() * box.size / 2.0);
  }
  WorldBox operator()(const SphereShape& sphere) const {
    return symmetric(Vector3d::Constant(sphere.radius));
  }
  WorldBox operator()(const CylinderShape& cylinder) const {
    const Vector3d axis = rotation.col(2);
    return symmetric(axis.cwiseAbs() * cylinder.height / 2.0 + disc_extents(axis, cylinder.radius));
  }
  WorldBox operator()(const ConeShape& cone) const {
    const Vector3d apex = rotation.col(2) * cone.height / 2.0;
    const Vector3d rim = disc_extents(rotation.col(2), cone.radius);
    return {apex.cwiseMin(-apex - rim), apex.cwiseMax(-apex + rim)};
  }
  WorldBox operator()(const CapsuleShape& capsule) const {
    return symmetric((rotation.col(2).cwiseAbs() * capsule.length / 2.0).array() + capsule.radius);
  }
  WorldBox operator()(const HalfSpaceShape& /*half_space*/) const { return everywhere(); }
  WorldBox operator()(const PlaneShape& /*plane*/) const { return everywhere(); }
  template <class Shared>
  WorldBox operator()(const std::shared_ptr<const Shared>& shared) const {
    const Vector3d centre = rotation * shared->box().center();
    const Vector3d half = rotation.cwiseAbs() * shared->box().sizes() / 2.0;
    return {centre - half, centre + half};
  }

  static WorldBox symmetric(const Vector3d& half) { return {-half, half}; }
  static WorldBox everywhere() {
    return symmetric(Vector3d::Constant(std::numeric_limits<double>::infinity()));
  }

  Eigen::Matrix3d rotation;
};

}  // namespace

void validate(const Shape& shape) { std::visit(Check(), shape); }

void validate(const Eigen::Isometry3d& pose) {
  const Vector3d position = pose.translation();
  for (const double coordinate : {position.x(), position.y(), position.z()}) {
    if (!FiberAssembly::is_valid_coordinate(coordinate)) {
      refuse("a coordinate of the pose", coordinate, "finite and at most 1e150 m in magnitude");
    }
  }
  const Eigen::Matrix3d rotation = pose.linear();
  const double deviation = (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm();
  if (!(deviation <= unit_tolerance) || !(rotation.determinant() > 0.0)) {
    throw std::invalid_argument("the orientation of the pose is no rotation");
  }
}

void validate(const EnvironmentObject& object) {
  if (object.name.empty()) {
    throw std::invalid_argument("an object has no name");
  }
  std::optional<std::size_t> shape;  // of the object, which an error is about
  try {
    validate(object.pose);
    for (std::size_t i = 0; i < object.shapes.size(); ++i) {
      shape = i;
      validate(object.shapes[i].shape);
      validate(object.shapes[i].pose);
    }
  } catch (const std::invalid_argument& error) {
    const std::string part = shape ? ", shape " + std::to_string(*shape) : "";
    throw std::invalid_argument("object " + quote(object.name) + part + ": " + error.what());
  }
}

bool have_same_shapes(const EnvironmentObject& x, const EnvironmentObject& y) {
  return std::equal(x.shapes.begin(), x.shapes.end(), y.shapes.begin(), y.shapes.end(),
                    [](const PlacedShape& one, const PlacedShape& other) {
                      return one.pose.matrix() == other.pose.matrix() && one.shape == other.shape;
                    });
}

WorldBox world_box(const Shape& shape, const Eigen::Isometry3d& pose) {
  // A few roundings of the largest number that has taken part.
  constexpr double error = 16.0 * std::numeric_limits<double>::epsilon();
  WorldBox box = std::visit(RotatedBox{pose.linear()}, shape);
  const double largest = reach(shape) + pose.translation().cwiseAbs().maxCoeff();
  const Vector3d padding = Vector3d::Constant(error * largest);
  box.min() += pose.translation() - padding;
  box.max() += pose.translation() + padding;
  return box;
}

bool is_bounded(const Shape& shape) {
  return !std::holds_alternative<HalfSpaceShape>(shape) &&
         !std::holds_alternative<PlaneShape>(shape);
}

double reach(const Shape& shape) { return std::visit(Reach(), shape); }

}  // namespace fiber
