#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>

#include "fiber_proximity/environment/axis_distance.hpp"
#include "fiber_proximity/environment/shape_box.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "src/environment/object_path.hpp"

namespace fiber {

/// A shape of an object where it is in the world, and perhaps where it moves from there.
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

  /// Makes the box one around the whole way. Refers to the path.
  void move_along(const ObjectPath& object_path) {
    path = &object_path;
    const double far = reach(shape) + in_object.translation().norm();
    const WorldBox last = world_box(shape, object_path.pose(1.0) * in_object);
    const Eigen::Vector3d padding = Eigen::Vector3d::Constant(object_path.arc_height(far));
    box.extend(last);
    box.min() -= padding;
    box.max() += padding;
  }

  std::uint32_t object;
  std::uint32_t index;  // of the shape in its object
  const Shape& shape;
  const Eigen::Isometry3d& in_object;
  Eigen::Isometry3d pose;
  Eigen::Isometry3d to_shape;
  WorldBox box;
  double rounding;                   // [m] what its place adds to the error of a distance
  const ObjectPath* path = nullptr;  // null where it stands still
};

}  // namespace fiber
