#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "src/environment/object_path.hpp"
#include "src/environment/shape_boxes.hpp"
#include "src/environment/world_shape.hpp"

namespace fiber {

/// The shapes of objects that move, found by where they come along during one motion.
///
/// Each has a box around its whole way.
class MovingShapes {
 public:
  /// Holds references to all that it is given.
  /// @param paths  by object; those that stand still are none of its business
  /// @param around [m] shapes that never come into this box are not found
  MovingShapes(const std::vector<WorldShape>& shapes, const std::vector<ObjectPath>& paths,
               const WorldBox& around);

  bool moves(const WorldShape& shape) const { return paths_[shape.object].moves(); }

  const ObjectPath& path(const WorldShape& shape) const { return paths_[shape.object]; }

  /// Whether no shape stands still.
  bool are_all() const { return are_all_; }

  /// A close box around the whole way of a shape; infinite of planes and half-spaces.
  const WorldBox& box(const WorldShape& shape);

  /// Around whole ways, no less.
  const ShapeBoxes& boxes() const { return boxes_; }

 private:
  const std::vector<WorldShape>& shapes_;
  const std::vector<ObjectPath>& paths_;
  bool are_all_ = true;
  ShapeBoxes boxes_;
  std::vector<std::optional<WorldBox>> close_boxes_;  // by shape, once it was asked for
};

}  // namespace fiber
