#include "src/environment/shape_boxes.hpp"

#include "src/hierarchy/sort_keys.hpp"
#include "src/hierarchy/space_curve.hpp"

namespace fiber {

void ShapeBoxes::reserve(std::size_t shapes) { bounded_.reserve(shapes); }

void ShapeBoxes::add(const WorldShape& shape, const WorldBox& box) {
  if (is_bounded(shape.shape)) {
    bounded_.emplace_back(&shape, box);
  } else {
    unbounded_.push_back(&shape);
  }
}

void ShapeBoxes::build() {
  if (bounded_.empty()) {
    return;
  }
  sort_along_curve();
  std::vector<WorldBox> boxes;
  boxes.reserve(bounded_.size());
  for (const auto& [shape, box] : bounded_) {
    boxes.push_back(box);
  }
  add_level(boxes);
  while (boxes.size() > fan_out) {
    std::vector<WorldBox> above((boxes.size() + fan_out - 1) / fan_out);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      above[i / fan_out].extend(boxes[i]);
    }
    boxes = std::move(above);
    add_level(boxes);
  }
}

void ShapeBoxes::sort_along_curve() {
  if (bounded_.size() <= fan_out) {
    return;  // all of them share one box
  }
  // The curve takes middles of segments: these are from corner to corner of a box.
  std::vector<Eigen::Vector3d> corners;
  std::vector<std::uint32_t> first_corners;
  corners.reserve(2 * bounded_.size());
  first_corners.reserve(bounded_.size());
  for (const auto& [shape, box] : bounded_) {
    first_corners.push_back(static_cast<std::uint32_t>(corners.size()));
    corners.push_back(box.min());
    corners.push_back(box.max());
  }
  std::vector<std::uint64_t> keys(bounded_.size());
  std::vector<std::uint64_t> scratch;
  SpaceCurve(corners).key_segments(corners, first_corners.data(), keys.size(), keys.data());
  sort_keys(keys, scratch);
  std::vector<std::pair<const WorldShape*, WorldBox>> sorted;
  sorted.reserve(keys.size());
  for (const std::uint64_t key : keys) {
    sorted.push_back(bounded_[static_cast<std::uint32_t>(key) / 2]);
  }
  bounded_ = std::move(sorted);
}

void ShapeBoxes::add_level(const std::vector<WorldBox>& boxes) {
  Level level{boxes.size(), std::vector<EightBoxes>((boxes.size() + fan_out - 1) / fan_out)};
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    level.boxes[i / fan_out].set(i % fan_out, boxes[i]);
  }
  levels_.push_back(std::move(level));
}

}  // namespace fiber
