#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "src/environment/object_path.hpp"
#include "src/environment/world_shape.hpp"

namespace fiber {

/// The shapes of objects that move, found by where they come along during one motion.
///
/// Each has a box around its whole way. Eight boxes that are neighbours on a space-filling curve
/// share a box above them, and so on. Making FCL's tree, which serves many queries, would take
/// longer than this one.
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

  /// Calls visit(shape) for those whose boxes come as near as this [m] to a box.
  template <class Visit>
  void visit_near(const WorldBox& box, double within, const Visit& visit) const {
    for (const WorldShape* shape : unbounded_) {
      visit(*shape);
    }
    if (!levels_.empty()) {
      visit_children(levels_.size() - 1, 0, {box, within}, visit);
    }
  }

 private:
  static constexpr std::size_t fan_out = 8;

  struct Near {
    const WorldBox& box;
    double within;  // [m]

    bool holds(const WorldBox& other) const { return !(box.exteriorDistance(other) > within); }
  };

  /// Looks at the boxes of one level that share a box of the level above.
  template <class Visit>
  void visit_children(std::size_t level, std::size_t parent, const Near& near,
                      const Visit& visit) const {
    const std::vector<WorldBox>& boxes = levels_[level];
    const std::size_t end = std::min(boxes.size(), fan_out * (parent + 1));
    for (std::size_t i = fan_out * parent; i < end; ++i) {
      if (near.holds(boxes[i])) {
        if (level == 0) {
          visit(*bounded_[i]);
        } else {
          visit_children(level - 1, i, near, visit);
        }
      }
    }
  }

  void sort_along_curve(const std::vector<const WorldShape*>& shapes,
                        const std::vector<WorldBox>& boxes);
  void build_levels();

  const std::vector<WorldShape>& shapes_;
  const std::vector<ObjectPath>& paths_;
  bool are_all_ = true;
  std::vector<const WorldShape*> unbounded_;
  std::vector<const WorldShape*> bounded_;            // along the curve
  std::vector<std::vector<WorldBox>> levels_;         // the lowest one first, by bounded shape
  std::vector<std::optional<WorldBox>> close_boxes_;  // by shape, once it was asked for
};

}  // namespace fiber
