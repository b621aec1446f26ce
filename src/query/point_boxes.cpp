#include "src/query/point_boxes.hpp"

#include <utility>

namespace fiber {
namespace {

// Fibres of fewer points are walked along sooner than boxes are made.
constexpr std::uint32_t least_boxed_points = 256;

}  // namespace

/// A box around as many points, or boxes, each as one has below it.
template <class Item>
std::vector<Eigen::AlignedBox3d> PointBoxes::around(const Item* items, std::size_t count) {
  constexpr std::size_t width = std::size_t{1} << log_width;
  std::vector<Eigen::AlignedBox3d> boxes(count / width);
  for (std::size_t i = 0; i < boxes.size() * width; ++i) {
    boxes[i / width].extend(items[i]);
  }
  return boxes;
}

PointBoxes::PointBoxes(const FiberAssembly& fibers, std::uint32_t fiber)
    : begin_(fibers.offsets()[fiber]) {
  const std::uint32_t count = fibers.offsets()[fiber + 1] - begin_;
  if (count < least_boxed_points) {
    return;
  }
  const Eigen::Vector3d* const points = fibers.points().data() + begin_;
  std::vector<Eigen::AlignedBox3d> boxes = around(points, count);
  while (!boxes.empty()) {
    levels_.push_back(std::move(boxes));
    const std::vector<Eigen::AlignedBox3d>& below = levels_.back();
    boxes = around(below.data(), below.size());
  }
}

}  // namespace fiber
