#pragma once

#include <cstdint>
#include <limits>

#include "src/cuda/candidates.hpp"
#include "src/cuda/warp.hpp"
// The work of a lane is written for one.
#ifndef FIBER_ONE_LANE
#define FIBER_ONE_LANE
#endif
#include "src/hierarchy/segment_tests-inl.hpp"

namespace fiber {

/// A segment in single precision, relative to the tree's origin [m]. The radius is padded so that
/// every test errs on the safe side; infinite for a segment beyond the range of float, which is
/// near everything. A GPU reads 16 bytes at once.
struct alignas(16) TreeSegment {
  float start[3];
  float radius;
  float end[3];
  std::uint32_t point;  ///< its first one
};

/// [m] relative to the tree's origin.
struct alignas(16) TreeBox {
  float lower[3];
  float upper[3];

  FIBER_ON_DEVICE void take(const TreeBox& other) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = lower[axis] < other.lower[axis] ? lower[axis] : other.lower[axis];
      upper[axis] = upper[axis] > other.upper[axis] ? upper[axis] : other.upper[axis];
    }
  }
};

FIBER_ON_DEVICE inline bool overlap(const TreeBox& a, const TreeBox& b) {
  // All six at once: lanes that part after each of them wait for each other, and for memory.
  std::uint32_t apart = 0;
  for (int axis = 0; axis < 3; ++axis) {
    apart |= a.lower[axis] > b.upper[axis] ? 1U : 0U;
    apart |= b.lower[axis] > a.upper[axis] ? 1U : 0U;
  }
  return apart == 0;
}

/// The box around a segment, thicker by so much [m].
FIBER_ON_DEVICE inline TreeBox box_of(const TreeSegment& segment, float more) {
  TreeBox box{};
  const float reach = segment.radius + more;
  for (int axis = 0; axis < 3; ++axis) {
    const float from = segment.start[axis];
    const float to = segment.end[axis];
    box.lower[axis] = (from < to ? from : to) - reach;
    box.upper[axis] = (from > to ? from : to) + reach;
  }
  return box;
}

/// The tree as kernels read it: 32 wide, without pointers, in level order. Level 0 are the leaves,
/// 32 segments each that follow each other along a space-filling curve; the children of node n are
/// 32n … 32n + 31 one level down, as far as there are so many.
struct SegmentTreeView {
  static constexpr int max_levels = 7;
  /// Segments and nodes have numbers of 27 bits: five more tell a level or a lane beside them.
  static constexpr int place_bits = 27;
  static constexpr std::uint32_t max_segments = std::uint32_t{1} << place_bits;

  const TreeSegment* segments = nullptr;
  std::uint32_t segment_count = 0;
  int level_count = 0;
  const TreeBox* boxes[max_levels] = {};
  std::uint32_t box_counts[max_levels] = {};

  FIBER_ON_DEVICE std::uint32_t leaf_count() const { return level_count == 0 ? 0 : box_counts[0]; }
};

/// Points of fibres where the kernels are, and which of them start segments.
struct TreePoints {
  const double* coordinates = nullptr;  ///< three per point [m]
  const std::uint32_t* first_points = nullptr;
  std::uint32_t segment_count = 0;
  std::uint32_t point_count = 0;
  const double* radii = nullptr;  ///< by first point [m]; none where all have the one
  double radius = 0.0;            ///< [m]
  double origin[3] = {};          ///< [m]

  /// @param point the first one of a segment
  FIBER_ON_DEVICE double radius_of(std::uint32_t point) const {
    return radii == nullptr ? radius : radii[point];
  }
};

/// The box of all points [m].
struct PointBounds {
  double lower[3];
  double upper[3];

  FIBER_ON_DEVICE void take(const PointBounds& other) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = lower[axis] < other.lower[axis] ? lower[axis] : other.lower[axis];
      upper[axis] = upper[axis] > other.upper[axis] ? upper[axis] : other.upper[axis];
    }
  }
};

/// Writes the box around those of all lanes.
template <class Warp, class Box>
FIBER_ON_DEVICE void write_joined(Warp warp, const typename Warp::template PerLane<Box>& boxes,
                                  Box& to) {
  const Box all = warp.reduce(boxes, [](Box& a, const Box& b) { a.take(b); });
  warp.each([&](int lane) {
    if (lane == 0) {
      to = all;
    }
  });
}

/// Bounds of 1024 points each. Coordinates that are not finite, or beyond what fibres may have
/// (FiberAssembly::max_coordinate), are counted.
struct BoundPoints {
  static constexpr std::uint32_t rounds = 32;
  static constexpr std::uint32_t points_each = rounds * warp_width;
  struct Scratch {};

  TreePoints points;
  PointBounds* bounds;
  std::uint64_t* bad_count;

  template <class Warp>
  FIBER_ON_DEVICE void operator()(Warp warp, std::uint32_t index, Scratch& /*scratch*/) const {
    typename Warp::template PerLane<PointBounds> mine;
    typename Warp::template PerLane<std::uint32_t> bad;
    warp.each([&](int lane) {
      bad[lane] = 0;
      for (std::uint32_t round = 0; round < rounds; ++round) {
        const std::uint32_t point =
            index * points_each + round * warp_width + static_cast<std::uint32_t>(lane);
        const std::uint32_t last = points.point_count - 1;
        const double* const from =
            points.coordinates + 3 * std::size_t{point < last ? point : last};
        const PointBounds here{{from[0], from[1], from[2]}, {from[0], from[1], from[2]}};
        bad[lane] += point <= last ? bad_ones(from) : 0U;
        if (round == 0) {
          mine[lane] = here;
        } else {
          mine[lane].take(here);
        }
      }
    });
    write_joined(warp, mine, bounds[index]);
    const std::uint32_t all = warp.reduce(bad, [](std::uint32_t& a, std::uint32_t b) { a += b; });
    if (all != 0) {
      warp.raise(bad_count, std::uint64_t{all});
    }
  }

 private:
  FIBER_ON_DEVICE static std::uint32_t bad_ones(const double* point) {
    constexpr double largest = 1e150;
    std::uint32_t count = 0;
    for (int axis = 0; axis < 3; ++axis) {
      count += point[axis] <= largest && point[axis] >= -largest ? 0U : 1U;
    }
    return count;
  }
};

/// Boxes of 32 boxes each: nodes of a tree, or bounds.
template <class Box>
struct JoinBoxes {
  struct Scratch {};

  const Box* below;
  std::uint32_t below_count;
  Box* boxes;

  template <class Warp>
  FIBER_ON_DEVICE void operator()(Warp warp, std::uint32_t index, Scratch& /*scratch*/) const {
    typename Warp::template PerLane<Box> mine;
    warp.each([&](int lane) {
      const std::uint32_t child = index * warp_width + static_cast<std::uint32_t>(lane);
      mine[lane] = below[child < below_count ? child : below_count - 1];
    });
    write_joined(warp, mine, boxes[index]);
  }
};

/// Positions of the middles of segments along Hilbert's curve through the bounds, ten bits an axis:
/// SpaceCurve, a segment at a time. Of candidates the number comes first, and then what there is
/// room for: a shorter position is one of fewer bits an axis.
struct PlaceSegments {
  static constexpr std::uint32_t bits = 10;
  static constexpr double cells = (1U << bits) - 1U;
  static constexpr int max_bits = 3 * bits;

  TreePoints points;
  const PointBounds* bounds;
  std::uint32_t* keys;
  std::uint32_t* order;
  CandidateView candidates;
  const std::uint32_t* fibers;  ///< by point
  int position_bits;            ///< of keys, the lower ones

  FIBER_ON_DEVICE void operator()(std::uint32_t index) const {
    const std::uint32_t point = points.first_points[index];
    const double* const ends = points.coordinates + 3 * std::size_t{point};
    double extent = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double along = bounds->upper[axis] - bounds->lower[axis];
      extent = along > extent ? along : extent;
    }
    constexpr double most = 1e300;
    const double per_metre = extent * most > cells ? cells / extent : 0.0;
    std::uint32_t cell[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = 0.5 * ends[axis] + 0.5 * ends[axis + 3];
      const double at = (middle - bounds->lower[axis]) * per_metre;
      cell[axis] = at > 0.0 ? static_cast<std::uint32_t>(at < cells ? at : cells) : 0U;
    }
    std::uint32_t key = position(cell) >> (max_bits - position_bits);
    if (candidates.exist()) {
      key |= candidates.of_fibers[fibers[point]] << position_bits;
    }
    keys[index] = key;
    order[index] = point;
  }

 private:
  /// J. Skilling, Programming the Hilbert curve (2004): undo the turns of each level from the
  /// highest down, then Gray's code.
  FIBER_ON_DEVICE static std::uint32_t position(std::uint32_t (&cell)[3]) {
    constexpr std::uint32_t highest = 1U << (bits - 1);
    for (std::uint32_t bit = highest; bit > 1; bit >>= 1U) {
      const std::uint32_t below = bit - 1;
      for (std::uint32_t& axis : cell) {
        if ((axis & bit) != 0) {
          cell[0] ^= below;
        } else {
          const std::uint32_t exchange = (cell[0] ^ axis) & below;
          cell[0] ^= exchange;
          axis ^= exchange;
        }
      }
    }
    cell[1] ^= cell[0];
    cell[2] ^= cell[1];
    std::uint32_t gray = 0;
    for (std::uint32_t bit = highest; bit > 1; bit >>= 1U) {
      gray ^= (cell[2] & bit) != 0 ? bit - 1 : 0U;
    }
    std::uint32_t result = 0;
    for (std::uint32_t bit = highest; bit > 0; bit >>= 1U) {
      for (const std::uint32_t axis : cell) {
        result = result << 1U | (((axis ^ gray) & bit) != 0 ? 1U : 0U);
      }
    }
    return result;
  }
};

/// The segments in this order, as the tree has them.
struct ReadSegments {
  /// Beyond this magnitude squares leave the range of float: such a segment is near everything [m].
  static constexpr float largest_magnitude = 1e18F;

  TreePoints points;
  const std::uint32_t* order;
  TreeSegment* segments;

  FIBER_ON_DEVICE void operator()(std::uint32_t index) const {
    const std::uint32_t point = order[index];
    const double* const ends = points.coordinates + 3 * std::size_t{point};
    TreeSegment segment{};
    segment.point = point;
    segment.radius = rounded(points.radius_of(point));
    float magnitude = segment.radius;
    for (int axis = 0; axis < 3; ++axis) {
      segment.start[axis] = rounded(ends[axis] - points.origin[axis]);
      segment.end[axis] = rounded(ends[axis + 3] - points.origin[axis]);
      magnitude = larger(
          magnitude, larger(one_lane::Abs(segment.start[axis]), one_lane::Abs(segment.end[axis])));
    }
    segment.radius =
        magnitude > largest_magnitude
            ? std::numeric_limits<float>::infinity()
            : segment.radius + magnitude * one_lane::relative_padding + one_lane::min_padding;
    segments[index] = segment;
  }

 private:
  FIBER_ON_DEVICE static float larger(float a, float b) { return a > b ? a : b; }
  FIBER_ON_DEVICE static float rounded(double value) {
    constexpr double limit = 2.0 * static_cast<double>(largest_magnitude);
    return static_cast<float>(value > limit ? limit : value < -limit ? -limit : value);
  }
};

/// Boxes of the leaves.
struct FitLeaves {
  struct Scratch {};

  const TreeSegment* segments;
  std::uint32_t segment_count;
  TreeBox* boxes;

  template <class Warp>
  FIBER_ON_DEVICE void operator()(Warp warp, std::uint32_t index, Scratch& /*scratch*/) const {
    typename Warp::template PerLane<TreeBox> mine;
    warp.each([&](int lane) {
      const std::uint32_t place = index * warp_width + static_cast<std::uint32_t>(lane);
      const TreeSegment segment = segments[place < segment_count ? place : segment_count - 1];
      mine[lane] = box_of(segment, 0.0F);
    });
    write_joined(warp, mine, boxes[index]);
  }
};

}  // namespace fiber
