#include "src/query/point_boxes.hpp"

#include <utility>

namespace fiber {
namespace {

// Fibres of fewer points are walked along sooner than boxes are made.
constexpr std::uint32_t least_boxed_points = 256;

}  // namespace

PointBoxes::PointBoxes(const FiberAssembly& fibers, std::uint32_t fiber)
    : begin_(fibers.offsets()[fiber]) {
  const std::uint32_t count = fibers.offsets()[fiber + 1] - begin_;
  if (count < least_boxed_points) {
    return;
  }
  constexpr std::uint32_t width = 1U << log_width;
  const Eigen::Vector3d* const points = fibers.points().data() + begin_;
  std::vector<Box> boxes(count / width);
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    boxes[i] = {points[i * width], points[i * width]};
    for (std::size_t k = i * width + 1; k < (i + 1) * width; ++k) {
      boxes[i].lower = boxes[i].lower.cwiseMin(points[k]);
      boxes[i].upper = boxes[i].upper.cwiseMax(points[k]);
    }
  }
  while (!boxes.empty()) {
    levels_.push_back(std::move(boxes));
    const std::vector<Box>& below = levels_.back();
    boxes.assign(below.size() / width, Box());
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      boxes[i] = below[i * width];
      for (std::size_t k = i * width + 1; k < (i + 1) * width; ++k) {
        boxes[i].lower = boxes[i].lower.cwiseMin(below[k].lower);
        boxes[i].upper = boxes[i].upper.cwiseMax(below[k].upper);
      }
    }
  }
}

}  // namespace fiber
