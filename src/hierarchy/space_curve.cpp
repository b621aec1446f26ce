// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/hierarchy/space_curve.cpp"
#include "src/hierarchy/space_curve.hpp"

#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#ifndef FIBER_SPACE_CURVE_BLOCK
#define FIBER_SPACE_CURVE_BLOCK
namespace fiber {

constexpr unsigned curve_bits = 10;  // an axis; three fill 30 of 32
constexpr std::size_t curve_block = 64;

/// Cells of some points by axis.
struct alignas(64) CellBlock {
  std::uint32_t cells[3][curve_block];
  std::uint32_t positions[curve_block];
};

}  // namespace fiber
#endif

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<std::uint32_t, 16>;
using Word = hn::Vec<Words>;

/// Two zero bits behind each of the lower ten bits.
HWY_INLINE Word spread_bits(Word bits) {
  const Words d;
  bits = hn::And(hn::Or(bits, hn::ShiftLeft<16>(bits)), hn::Set(d, 0x030000FFU));
  bits = hn::And(hn::Or(bits, hn::ShiftLeft<8>(bits)), hn::Set(d, 0x0300F00FU));
  bits = hn::And(hn::Or(bits, hn::ShiftLeft<4>(bits)), hn::Set(d, 0x030C30C3U));
  return hn::And(hn::Or(bits, hn::ShiftLeft<2>(bits)), hn::Set(d, 0x09249249U));
}

/// A bit of x decides about the bits below: x and the first axis swap them where it is 0, the
/// first axis inverts them where it is 1.
HWY_INLINE void turn(Word& first, Word& x, std::uint32_t bit) {
  const Words d;
  const auto below = hn::Set(d, bit - 1);
  const auto is_set = hn::VecFromMask(d, hn::TestBit(x, hn::Set(d, bit)));
  const auto exchange = hn::AndNot(is_set, hn::And(hn::Xor(first, x), below));
  first = hn::Xor(first, hn::Or(hn::And(is_set, below), exchange));
  x = hn::Xor(x, exchange);
}

/// Positions along the curve, by Skilling's walk over the bits from the highest down (J. Skilling,
/// Programming the Hilbert curve, 2004): undo the turns of each level, then Gray's code.
void find_positions_lanes(CellBlock& block) {
  const Words d;
  for (std::size_t lane = 0; lane < curve_block; lane += hn::Lanes(d)) {
    auto x = hn::Load(d, block.cells[0] + lane);
    auto y = hn::Load(d, block.cells[1] + lane);
    auto z = hn::Load(d, block.cells[2] + lane);
    for (std::uint32_t bit = 1U << (curve_bits - 1); bit > 1; bit >>= 1U) {
      const auto below = hn::Set(d, bit - 1);
      const auto is_set = hn::VecFromMask(d, hn::TestBit(x, hn::Set(d, bit)));
      x = hn::Xor(x, hn::And(is_set, below));
      turn(x, y, bit);
      turn(x, z, bit);
    }
    y = hn::Xor(y, x);
    z = hn::Xor(z, y);
    auto gray = hn::Zero(d);
    for (std::uint32_t bit = 1U << (curve_bits - 1); bit > 1; bit >>= 1U) {
      const auto is_set = hn::VecFromMask(d, hn::TestBit(z, hn::Set(d, bit)));
      gray = hn::Xor(gray, hn::And(is_set, hn::Set(d, bit - 1)));
    }
    const auto position = hn::Or(
        hn::ShiftLeft<2>(spread_bits(hn::Xor(x, gray))),
        hn::Or(hn::ShiftLeft<1>(spread_bits(hn::Xor(y, gray))), spread_bits(hn::Xor(z, gray))));
    hn::Store(position, d, block.positions + lane);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <tbb/blocked_range.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>

namespace fiber {

HWY_EXPORT(find_positions_lanes);

namespace {

constexpr double cells = (1U << curve_bits) - 1U;

struct Bounds {
  Eigen::Vector3d lower;
  Eigen::Vector3d upper;
};

Bounds bounds_of(const std::vector<Eigen::Vector3d>& points) {
  constexpr std::size_t points_per_job = 1U << 14U;
  using Range = tbb::blocked_range<std::size_t>;
  return tbb::parallel_reduce(
      Range(0, points.size(), points_per_job), Bounds{points.front(), points.front()},
      [&](const Range& range, Bounds bounds) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          bounds.lower = bounds.lower.cwiseMin(points[i]);
          bounds.upper = bounds.upper.cwiseMax(points[i]);
        }
        return bounds;
      },
      [](const Bounds& a, const Bounds& b) {
        return Bounds{a.lower.cwiseMin(b.lower), a.upper.cwiseMax(b.upper)};
      });
}

/// The cell of a coordinate; whatever overflows is in the first one.
std::uint32_t cell_of(double offset, double cells_per_metre) {
  const double cell = offset * cells_per_metre;
  return cell > 0.0 ? static_cast<std::uint32_t>(std::min(cell, cells)) : 0U;
}

}  // namespace

SpaceCurve::SpaceCurve(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) {
    return;
  }
  const Bounds bounds = bounds_of(points);
  lower_ = bounds.lower;
  const double extent = (bounds.upper - bounds.lower).maxCoeff();
  cells_per_metre_ = extent > 0.0 ? std::min(cells / extent, 1e300) : 0.0;
}

void SpaceCurve::key_segments(const std::vector<Eigen::Vector3d>& points,
                              const std::uint32_t* first_points, std::size_t count,
                              std::uint64_t* keys) const {
  CellBlock block{};
  for (std::size_t begin = 0; begin < count; begin += curve_block) {
    const std::size_t size = std::min(curve_block, count - begin);
    for (std::size_t i = 0; i < size; ++i) {
      const Eigen::Vector3d& start = points[first_points[begin + i]];
      const Eigen::Vector3d& end = points[first_points[begin + i] + 1];
      for (int axis = 0; axis < 3; ++axis) {
        block.cells[axis][i] =
            cell_of(0.5 * start[axis] + 0.5 * end[axis] - lower_[axis], cells_per_metre_);
      }
    }
    HWY_DYNAMIC_DISPATCH(find_positions_lanes)(block);
    for (std::size_t i = 0; i < size; ++i) {
      keys[begin + i] = std::uint64_t{block.positions[i]} << 32U | first_points[begin + i];
    }
  }
}

}  // namespace fiber
#endif
