#include "fiber_proximity/environment/shape_box.hpp"

#include <cmath>
#include <limits>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "src/environment/occupancy_octree.hpp"

namespace fiber {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

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

  Matrix3d rotation;
};

}  // namespace

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

}  // namespace fiber
