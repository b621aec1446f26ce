#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/environment/object_path.hpp"

namespace fiber {

/// A shape of an object where it is in the world.
struct WorldShape {
  WorldShape(const EnvironmentObject& owner, std::uint32_t object_index, std::uint32_t shape_index)
      : object(object_index),
        index(shape_index),
        shape(owner.shapes[shape_index].shape),
        in_object(owner.shapes[shape_index].pose),
        pose(owner.pose * in_object),
        to_shape(pose.inverse(Eigen::Isometry)),
        box(world_box(shape, pose)),
        rounding(0x1p-48 * (reach(shape) + pose.translation().cwiseAbs().maxCoeff())) {}

  /// A box around the whole way of the shape.
  WorldBox box_along(const ObjectPath& path) const {
    const double far = reach(shape) + in_object.translation().norm();
    const WorldBox last = world_box(shape, path.pose(1.0) * in_object);
    const Eigen::Vector3d padding = Eigen::Vector3d::Constant(path.arc_height(far));
    WorldBox around = box;
    around.extend(last);
    around.min() -= padding;
    around.max() += padding;
    return around;
  }

  /// [m] How much the distance of a segment from the shape may be off.
  double error(const Capsule& segment) const {
    return rounding +
           0x1p-48 * std::max(segment.p0.cwiseAbs().maxCoeff(), segment.p1.cwiseAbs().maxCoeff());
  }

  std::uint32_t object;
  std::uint32_t index;  // of the shape in its object
  const Shape& shape;
  const Eigen::Isometry3d& in_object;
  Eigen::Isometry3d pose;
  Eigen::Isometry3d to_shape;
  WorldBox box;
  double rounding;  // [m] what its place adds to the error of a distance
};

}  // namespace fiber
