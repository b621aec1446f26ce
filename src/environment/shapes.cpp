#include "fiber_proximity/environment/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

/// How far from one the length of a unit vector and the determinant of a rotation may be.
constexpr double unit_tolerance = 1e-6;

[[noreturn]] void refuse(const std::string& what, double value, const std::string& rule) {
  std::ostringstream message;
  message << what << " is " << value << ", it must be " << rule;
  throw std::invalid_argument(message.str());
}

void check_length(const std::string& what, double length) {
  if (!FiberAssembly::is_valid_radius(length)) {
    refuse(what, length, "finite, at least 0 and at most 1e150 m");
  }
}

void check_sheet(const std::string& what, const Eigen::Vector3d& normal, double offset) {
  if (!(std::abs(normal.norm() - 1.0) <= unit_tolerance)) {
    refuse("length of the " + what + "'s normal", normal.norm(), "1");
  }
  if (!FiberAssembly::is_valid_coordinate(offset)) {
    refuse("offset of the " + what, offset, "finite and at most 1e150 m in magnitude");
  }
}

struct Check {
  void operator()(const BoxShape& box) const {
    for (int axis = 0; axis < 3; ++axis) {
      check_length("size of the box along axis " + std::to_string(axis), box.size[axis]);
    }
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

bool is_same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return a.matrix() == b.matrix();
}

struct IsSameSolid {
  bool operator()(const BoxShape& x, const BoxShape& y) const { return x.size == y.size; }
  bool operator()(const SphereShape& x, const SphereShape& y) const { return x.radius == y.radius; }
  bool operator()(const CapsuleShape& x, const CapsuleShape& y) const {
    return x.radius == y.radius && x.length == y.length;
  }
  template <class Upright>  // a cylinder or a cone
  auto operator()(const Upright& x, const Upright& y) const -> decltype(x.height == y.height) {
    return x.radius == y.radius && x.height == y.height;
  }
  template <class Sheet>  // a plane or a half-space
  auto operator()(const Sheet& x, const Sheet& y) const -> decltype(x.normal == y.normal) {
    return x.normal == y.normal && x.offset == y.offset;
  }
  template <class Shared>
  bool operator()(const std::shared_ptr<const Shared>& x,
                  const std::shared_ptr<const Shared>& y) const {
    return x == y;
  }
  template <class One, class Other>
  std::enable_if_t<!std::is_same_v<One, Other>, bool> operator()(const One& /*x*/,
                                                                 const Other& /*y*/) const {
    return false;
  }
};

}  // namespace

void validate(const Shape& shape) { std::visit(Check(), shape); }

void validate(const Eigen::Isometry3d& pose) {
  const Eigen::Vector3d position = pose.translation();
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
  const std::string name = "object " + quote(object.name);
  with_context(name, [&] { validate(object.pose); });
  for (std::size_t i = 0; i < object.shapes.size(); ++i) {
    with_context(name + ", shape " + std::to_string(i), [&] {
      validate(object.shapes[i].shape);
      validate(object.shapes[i].pose);
    });
  }
}

bool have_same_shapes(const EnvironmentObject& x, const EnvironmentObject& y) {
  return std::equal(x.shapes.begin(), x.shapes.end(), y.shapes.begin(), y.shapes.end(),
                    [](const PlacedShape& one, const PlacedShape& other) {
                      return is_same(one.pose, other.pose) &&
                             std::visit(IsSameSolid(), one.shape, other.shape);
                    });
}

}  // namespace fiber
