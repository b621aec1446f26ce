#include "src/environment/moving_shapes.hpp"

#include <algorithm>

#include "src/hierarchy/sort_keys.hpp"
#include "src/hierarchy/space_curve.hpp"

namespace fiber {
namespace {

/// A box around the whole way of a shape that takes little time to find, and has room for the close
/// one.
WorldBox wide_box(const WorldShape& shape, const ObjectPath& path) {
  WorldBox box = shape.box;
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
  std::vector<const WorldShape*> bounded;
  std::vector<WorldBox> boxes;
  bounded.reserve(shapes.size());
  boxes.reserve(shapes.size());
  for (const WorldShape& shape : shapes) {
    if (!moves(shape)) {
      are_all_ = false;
    } else if (!is_bounded(shape.shape)) {
      unbounded_.push_back(&shape);
    } else if (const WorldBox box = wide_box(shape, path(shape)); box.intersects(around)) {
      bounded.push_back(&shape);
      boxes.push_back(box);
    }
  }
  if (!bounded.empty()) {
    sort_along_curve(bounded, boxes);
    build_levels();
  }
}

const WorldBox& MovingShapes::box(const WorldShape& shape) {
  std::optional<WorldBox>& box = close_boxes_[static_cast<std::size_t>(&shape - shapes_.data())];
  if (!box) {
    box = shape.box_along(path(shape));
  }
  return *box;
}

void MovingShapes::sort_along_curve(const std::vector<const WorldShape*>& shapes,
                                    const std::vector<WorldBox>& boxes) {
  // The curve takes middles of segments: these are from corner to corner of a box.
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::uint32_t> first_corners;
  corners.reserve(2 * boxes.size());
  first_corners.reserve(boxes.size());
  for (const WorldBox& box : boxes) {
    first_corners.push_back(static_cast<std::uint32_t>(corners.size()));
    corners.push_back(box.min());
    corners.push_back(box.max());
  }
  std::vector<std::uint64_t> keys(boxes.size());
  std::vector<std::uint64_t> scratch;
  SpaceCurve(corners).key_segments(corners, first_corners.data(), boxes.size(), keys.data());
  sort_keys(keys, scratch);
  levels_.emplace_back();
  levels_[0].reserve(boxes.size());
  bounded_.reserve(boxes.size());
  for (const std::uint64_t key : keys) {
    const std::size_t index = static_cast<std::uint32_t>(key) / 2;
    bounded_.push_back(shapes[index]);
    levels_[0].push_back(boxes[index]);
  }
}

void MovingShapes::build_levels() {
  while (levels_.back().size() > fan_out) {
    const std::vector<WorldBox>& below = levels_.back();
    std::vector<WorldBox> level((below.size() + fan_out - 1) / fan_out);
    for (std::size_t i = 0; i < below.size(); ++i) {
      level[i / fan_out].extend(below[i]);
    }
    levels_.push_back(std::move(level));
  }
}

}  // namespace fiber
