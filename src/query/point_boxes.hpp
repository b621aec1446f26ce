#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Boxes around 16, 16², 16³, … points of a fibre that follow each other: of many points at once
/// they tell that something holds for all. Short fibres have none.
class PointBoxes {
 public:
  /// Makes them, in the memory it has.
  void fit(const FiberAssembly& fibers, std::uint32_t fiber);

  /// How many points from this one on, and not beyond the last, are in the largest box that begins
  /// here and is within; 0 if none is.
  /// @param is_within tells whether all that is in an Eigen::AlignedBox3d is
  template <class IsWithin>
  std::uint32_t count_within(std::uint32_t point, std::uint32_t last,
                             const IsWithin& is_within) const {
    const std::uint32_t index = point - begin_;
    std::uint32_t level = 0;
    while (level < level_count_ && index % size_of(level) == 0 &&
           size_of(level) - 1 <= last - point) {
      ++level;
    }
    while (level-- > 0) {
      const Eigen::AlignedBox3d& box = levels_[level][index / size_of(level)];
      if (is_within(box)) {
        return size_of(level);
      }
    }
    return 0;
  }

  std::size_t memory_bytes() const;

 private:
  static constexpr std::uint32_t log_width = 4;

  /// In points.
  static std::uint32_t size_of(std::size_t level) {
    return 1U << (log_width * (static_cast<std::uint32_t>(level) + 1));
  }

  template <class Item>
  static void fit_around(const Item* items, std::size_t count,
                         std::vector<Eigen::AlignedBox3d>& boxes);

  std::uint32_t begin_ = 0;
  std::size_t level_count_ = 0;
  std::vector<std::vector<Eigen::AlignedBox3d>>
      levels_;  // of whole boxes only; more than there are
};

}  // namespace fiber
