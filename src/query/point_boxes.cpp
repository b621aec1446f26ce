#include "src/query/point_boxes.hpp"

namespace fiber {
namespace {

// Fibres of fewer points are walked along sooner than boxes are made.
constexpr std::uint32_t least_boxed_points = 256;

}  // namespace

/// Boxes around as many points, or boxes, each as one has below it.
template <class Item>
void PointBoxes::fit_around(const Item* items, std::size_t count,
                            std::vector<Eigen::AlignedBox3d>& boxes) {
  constexpr std::size_t width = std::size_t{1} << log_width;
  boxes.assign(count / width, Eigen::AlignedBox3d());
  for (std::size_t i = 0; i < boxes.size() * width; ++i) {
    boxes[i / width].extend(items[i]);
  }
}

void PointBoxes::fit(const FiberAssembly& fibers, std::uint32_t fiber) {
  begin_ = fibers.offsets()[fiber];
  level_count_ = 0;
  const std::uint32_t count = fibers.offsets()[fiber + 1] - begin_;
  if (count < least_boxed_points) {
    return;
  }
  for (std::size_t left = count >> log_width; left > 0; left >>= log_width) {
    if (levels_.size() == level_count_) {
      levels_.emplace_back();
    }
    if (level_count_ == 0) {
      fit_around(fibers.points().data() + begin_, count, levels_[0]);
    } else {
      const std::vector<Eigen::AlignedBox3d>& below = levels_[level_count_ - 1];
      fit_around(below.data(), below.size(), levels_[level_count_]);
    }
    ++level_count_;
  }
}

std::size_t PointBoxes::memory_bytes() const {
  std::size_t bytes = levels_.capacity() * sizeof(std::vector<Eigen::AlignedBox3d>);
  for (const std::vector<Eigen::AlignedBox3d>& level : levels_) {
    bytes += level.capacity() * sizeof(level[0]);
  }
  return bytes;
}

}  // namespace fiber
