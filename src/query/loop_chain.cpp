#include "src/query/loop_chain.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "src/geometry/norm.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

// δ in radii: √2·1.75 < 5/2, the rest is for rounding.
constexpr double max_fall_back = 1.75;

// Products of shorter steps may lose digits.
constexpr double min_step = 0x1p-1000;

/// Whether these points fall back along none of the four directions by more than the limit [m].
/// Every step is first shortened by all that rounding may have added.
bool is_loop_free(const std::vector<Vector3d>& points, std::uint32_t first, std::uint32_t last,
                  double limit) {
  const Vector3d axis = unit_of(points[last] - points[first]);
  if (axis.isZero(0.0)) {
    return false;
  }
  const Vector3d side = axis.unitOrthogonal();
  const Vector3d other_side = axis.cross(side);
  const std::array<Vector3d, 4> directions{axis + side, axis - side, axis + other_side,
                                           axis - other_side};
  std::array<double, 4> fall_back{};
  for (std::uint32_t i = first; i < last; ++i) {
    const Vector3d step = points[i + 1] - points[i];
    const double size = step.cwiseAbs().sum();
    if (size == 0.0) {
      continue;
    }
    if (size < min_step) {
      return false;
    }
    for (std::size_t d = 0; d < directions.size(); ++d) {
      const double advance = directions[d].dot(step) - 0x1p-40 * size;
      fall_back[d] = std::max(0.0, fall_back[d] - advance);
      if (fall_back[d] > limit) {
        return false;
      }
    }
  }
  return true;
}

// Fibres of fewer points are walked along sooner than boxes are made.
constexpr std::uint32_t min_boxed_points = 256;

}  // namespace

void LoopFreeStretches::find(const FiberAssembly& fibers, std::uint32_t fiber, double thinnest) {
  begin_ = fibers.offsets()[fiber];
  first_.resize(fibers.offsets()[fiber + 1] - begin_);
  last_.resize(first_.size());
  const double limit = max_fall_back * thinnest;
  const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
  std::uint32_t count = last - begin_;  // of segments to try
  std::uint32_t furthest = begin_;      // point of the stretches so far
  for (std::uint32_t first = begin_; first <= last;) {
    std::uint32_t end = first + std::min(count, last - first);
    while (end > first + 1 && !is_loop_free(fibers.points(), first, end, limit)) {
      end = first + (end - first) / 2;
    }
    // The next one begins half-way, so that near points share a stretch.
    const std::uint32_t next = end == last ? last + 1 : first + std::max(1U, (end - first) / 2);
    furthest = std::max(furthest, end);
    std::fill(last_.begin() + (first - begin_), last_.begin() + (next - begin_), furthest);
    count = 4 * std::max(1U, end - first);
    first = next;
  }
  std::uint32_t first = begin_;
  for (std::uint32_t point = begin_; point <= last; ++point) {
    while (!hold(first, point)) {
      ++first;
    }
    first_[point - begin_] = first;
  }
}

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
  if (count < min_boxed_points) {
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
