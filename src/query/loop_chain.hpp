#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Stretches of a fibre in which no two places are joined by a loop (LoopTest).
///
/// A stretch is loop-free if along four directions, an axis e ± two at right angles to it, it never
/// falls back by more than δ, where √2·δ is at most 5/2 radii. Proof: let v be the vector from a
/// place x to a later one k, w that from k to a still later one y, and z = v + w. In coordinates
/// (a, b, c) along e and the two others, |b| and |c| of both v and w are at most a + δ.
/// - If v has a ≤ 0, then |v| ≤ √2·δ. If w has, then |w| ≤ √2·δ, and |v| ≤ |z| + √2·δ.
/// - Otherwise, with b and c of v taken positive, the part of z along (2, 1, 1)/√6 is at least
///   m = (2a + b + c − 2δ)/√6, because that of w along it is at least −2δ/√6. Where m ≤ 0, v is in
///   a polytope whose corners are within √2·δ. Where m ≥ 0, f = κ·m + √2·δ − |v| is concave, not
///   negative at the corners of the polyhedron that v is in, and does not fall along its rays, the
///   directions (1, 0, 0), (1, 1, 0), (1, 0, 1) and (1, 1, 1), for every κ ≥ √(3/2) = 1.225.
/// So |v| ≤ κ·|z| + √2·δ, of w the same, and 5/4 is above κ by more than anything is rounded.
class LoopFreeStretches {
 public:
  /// Finds them in time linear in the fibre's points, in the memory it has.
  /// @param thinnest radius of the fibre's segments [m]
  void find(const FiberAssembly& fibers, std::uint32_t fiber, double thinnest);

  /// Whether one of them holds the points first … last of the fibre.
  bool hold(std::uint32_t first, std::uint32_t last) const { return last <= last_[first - begin_]; }

  /// The segments that one of them holds together with the one that starts at this point.
  PointRange around(std::uint32_t point) const {
    return {first_[point + 1 - begin_], last_[point - begin_]};
  }

  std::size_t memory_bytes() const {
    return (first_.capacity() + last_.capacity()) * sizeof(std::uint32_t);
  }

 private:
  std::uint32_t begin_ = 0;  // the fibre's first point
  // By point, the first and the last one that a stretch holds together with it.
  std::vector<std::uint32_t> first_;
  std::vector<std::uint32_t> last_;
};

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
