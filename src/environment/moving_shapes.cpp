#include "src/environment/moving_shapes.hpp"

namespace fiber {
namespace {

/// A box around the whole way of a shape that takes little time to find, and has room for the close
/// one.
WorldBox wide_box(const WorldShape& shape, const ObjectPath& path) {
  WorldBox box = shape.box;
  if (!is_bounded(shape.shape)) {
    return box;
  }
  if (path.turns()) {
    const Eigen::Vector3d origin = path.origin(0.0);
    const double far =
        (box.max() - origin).cwiseAbs().cwiseMax((origin - box.min()).cwiseAbs()).norm();
    const double padding = (path.turn_length(far) + path.arc_height(far)) * (1.0 + 0x1p-40);
    box.min().array() -= padding;
    box.max().array() += padding;
  }
  box.min() += path.way().cwiseMin(0.0);
  box.max() += path.way().cwiseMax(0.0);
  const double rounding =
      0x1p-48 * (box.min().cwiseAbs().cwiseMax(box.max().cwiseAbs())).maxCoeff();
  box.min().array() -= rounding;
  box.max().array() += rounding;
  return box;
}

}  // namespace

MovingShapes::MovingShapes(const std::vector<WorldShape>& shapes,
                           const std::vector<ObjectPath>& paths, const WorldBox& around)
    : shapes_(shapes), paths_(paths), close_boxes_(shapes.size()) {
  boxes_.reserve(shapes.size());
  for (const WorldShape& shape : shapes) {
    if (!moves(shape)) {
      are_all_ = false;
    } else if (const WorldBox box = wide_box(shape, path(shape)); box.intersects(around)) {
      boxes_.add(shape, box);
    }
  }
  boxes_.build();
}

const WorldBox& MovingShapes::box(const WorldShape& shape) {
  std::optional<WorldBox>& box = close_boxes_[static_cast<std::size_t>(&shape - shapes_.data())];
  if (!box) {
    box = shape.box_along(path(shape));
  }
  return *box;
}

}  // namespace fiber
