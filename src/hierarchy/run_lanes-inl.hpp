// A segment, or its box, against the eight of a run; and segments that move, in the lanes of a
// register, with a test of the least distance that they come to, which never misses. Included once
// per instruction set, so it has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_RUN_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_RUN_LANES_INL
#undef FIBER_RUN_LANES_INL
#else
#define FIBER_RUN_LANES_INL
#endif

#include <hwy/highway.h>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

// The vectors from segment b to segment a while both move are w + s·u − t·v + r·m, with w from
// start to start halfway, s and t in [0, 1], and r in [−1, 1] for half of the displacement of a
// relative to b: a parallelepiped. The segments stay apart if a plane has it further from the
// origin than their reach. Any plane proves it; which one is tried, by its normal, is a guess.

/// Pairs of segments that move.
class MovingPairs {
 public:
  /// @param displacement half of that of a relative to b [m]
  MovingPairs(const LaneSegments& a, const LaneSegments& b, const LaneVector& displacement,
              Lanes reach)
      : u_(a.direction),
        v_(b.direction),
        w_(subtract(a.start, b.start)),
        displacement_(displacement) {
    const Floats d;
    // Each dot product rounds by less than 8 u of the lengths of its factors.
    const auto extent = hn::Add(hn::Add(length_bound(u_), length_bound(v_)),
                                hn::Add(length_bound(w_), length_bound(displacement_)));
    limit_ = hn::MulAdd(extent, hn::Set(d, rounding_of_products), reach);
    squared_u_inverse_ = a.inverse_squared_length;
    squared_v_inverse_ = b.inverse_squared_length;
  }

  /// Tries planes along each segment's displacement, and that through the shortest vector about
  /// when the middles are nearest. That along both segments has been tried: moving_lines_near().
  LaneMask are_near() const {
    const Floats d;
    const auto one = hn::Set(d, 1.0F);
    const auto half_of_one = hn::Set(d, 0.5F);
    const auto squared_way =
        hn::Max(dot(displacement_, displacement_), hn::Set(d, std::numeric_limits<float>::min()));
    const LaneVector middles = along(along(w_, half_of_one, u_), hn::Neg(half_of_one), v_);
    const auto nearest_time = hn::Neg(hn::Div(dot(middles, displacement_), squared_way));
    const auto time = hn::Min(hn::Max(nearest_time, hn::Neg(one)), one);
    return hn::Not(
        hn::Or(hn::Or(are_beyond(cross(u_, displacement_)), are_beyond(cross(v_, displacement_))),
               are_beyond(shortest(along(w_, time, displacement_)))));
  }

 private:
  /// Whether a plane at right angles to this has all further from the origin than the limit.
  HWY_INLINE LaneMask are_beyond(const LaneVector& normal) const {
    const Floats d;
    const auto zero = hn::Zero(d);
    const auto squared = dot(normal, normal);
    const auto start = dot(normal, w_);
    const auto along_u = dot(normal, u_);
    const auto along_v = dot(normal, v_);
    const auto along_way = hn::Abs(dot(normal, displacement_));
    const auto least = hn::Sub(hn::Add(start, hn::Min(along_u, zero)), hn::Max(along_v, zero));
    const auto most = hn::Sub(hn::Add(start, hn::Max(along_u, zero)), hn::Min(along_v, zero));
    const auto gap = hn::Sub(hn::Max(least, hn::Neg(most)), along_way);
    // Below, squares are rounded to few digits.
    const auto smallest = hn::Set(d, 0x1p24F * std::numeric_limits<float>::min());
    return hn::And(hn::Gt(squared, smallest), hn::Gt(gap, hn::Mul(limit_, hn::Sqrt(squared))));
  }

  /// About the shortest of the vectors at one time.
  HWY_INLINE LaneVector shortest(const LaneVector& start) const {
    const Floats d;
    const auto zero = hn::Zero(d);
    const auto one = hn::Set(d, 1.0F);
    const auto clamp = [&](Lanes value) { return hn::Min(hn::Max(value, zero), one); };
    const auto uv = dot(u_, v_);
    const auto start_u = dot(start, u_);
    const auto start_v = dot(start, v_);
    const auto part_u = hn::Mul(uv, squared_u_inverse_);
    const auto part_v = hn::Mul(uv, squared_v_inverse_);
    // 1 − cos²: of nearly parallel ones any place serves.
    const auto least = hn::Set(d, 1e-4F);
    const auto sine = hn::Max(hn::NegMulAdd(part_u, part_v, one), least);
    auto s =
        clamp(hn::Div(hn::Mul(hn::MulSub(start_v, part_v, start_u), squared_u_inverse_), sine));
    const auto t = clamp(hn::Mul(hn::MulAdd(s, uv, start_v), squared_v_inverse_));
    s = clamp(hn::Mul(hn::MulSub(t, uv, start_u), squared_u_inverse_));
    return along(along(start, s, u_), hn::Neg(t), v_);
  }

  LaneVector u_;
  LaneVector v_;
  LaneVector w_;
  LaneVector displacement_;
  Lanes limit_;
  Lanes squared_u_inverse_;
  Lanes squared_v_inverse_;
};

/// lines_near() of segments that move, by `displacement` from halfway to either side, of a relative
/// to b.
HWY_INLINE LaneMask moving_lines_near(const LaneVector& u, const LaneVector& v, const LaneVector& w,
                                      const LaneVector& displacement, Lanes reach) {
  const Floats d;
  const LaneVector n = cross(u, v);
  const auto rounding = hn::Mul(hn::Set(d, rounding_of_products),
                                hn::Mul(hn::Add(length_bound(w), length_bound(displacement)),
                                        hn::Mul(length_bound(u), length_bound(v))));
  const auto across = hn::Sub(hn::Abs(dot(w, n)), hn::Abs(dot(displacement, n)));
  return within_reach(hn::Sub(across, rounding), reach, n);
}

/// Bits of the block's lanes whose boxes overlap the box in one lane of another. Infinite boxes
/// overlap everything.
HWY_INLINE std::uint32_t overlapping(const BoxBlock& block, const BoxBlock& other,
                                     std::uint32_t other_lane) {
  const LaneVector lower = spread(other.lower, other_lane);
  const LaneVector upper = spread(other.upper, other_lane);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(Floats())) {
    bits |= bits_of(boxes_overlap(load(block.lower, lane), load(block.upper, lane), lower, upper))
            << lane;
  }
  return bits;
}

/// Boxes of a run's segments, where they are and where they move.
template <bool moves>
HWY_INLINE void fit_boxes(const RunTreeView& tree, std::uint32_t which, BoxBlock& boxes) {
  const Run& run = tree.runs[which];
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(Floats())) {
    const LaneVector start = load(run.start, lane);
    const LaneVector end = load(run.end, lane);
    const auto radius = load(run.radius, lane);
    LaneVector lower = lower_corner(start, end, radius);
    LaneVector upper = upper_corner(start, end, radius);
    if constexpr (moves) {
      const LaneVector displacement = absolute(load(tree.displacements[which].half, lane));
      lower = subtract(lower, displacement);
      upper = add(upper, displacement);
    }
    store(lower, boxes.lower, lane);
    store(upper, boxes.upper, lane);
  }
}

/// Bits of a run's segments whose lines may come within the bound of that of a segment of another,
/// in the other tree.
template <bool moves>
HWY_INLINE std::uint32_t near_lines(const RunTreeView& tree, std::uint32_t which,
                                    const RunTreeView& other_tree, std::uint32_t other_which,
                                    std::uint32_t other_lane, float bound) {
  const Floats d;
  const Run& run = tree.runs[which];
  const Run& other = other_tree.runs[other_which];
  const LaneVector start = spread(other.start, other_lane);
  const LaneVector u = subtract(spread(other.end, other_lane), start);
  const auto reach = hn::Set(d, other.radius[other_lane] + bound);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const LaneVector starts = load(run.start, lane);
    const LaneVector v = subtract(load(run.end, lane), starts);
    const LaneVector w = subtract(start, starts);
    const auto reaches = hn::Add(reach, load(run.radius, lane));
    if constexpr (moves) {
      const LaneVector displacement =
          subtract(spread(other_tree.displacements[other_which].half, other_lane),
                   load(tree.displacements[which].half, lane));
      bits |= bits_of(moving_lines_near(u, v, w, displacement, reaches)) << lane;
    } else {
      bits |= bits_of(lines_near(u, v, w, reaches)) << lane;
    }
  }
  return bits;
}

/// Bits of the run's segments, by their first points, that share a point with another segment.
/// Points p and p + 1 start segments of one fibre: the last point of a fibre starts none.
HWY_INLINE std::uint32_t sharing_point(const std::uint32_t* first_points, std::uint32_t other) {
  const hn::RebindToUnsigned<Floats> d;
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto points = hn::LoadU(d, first_points + lane);
    const auto shared =
        hn::Or(hn::Eq(points, hn::Set(d, other - 1)), hn::Eq(points, hn::Set(d, other + 1)));
    bits |= bits_of(hn::RebindMask(Floats(), shared)) << lane;
  }
  return bits;
}

/// Bits of the run's segments, by their first points, that are in the range.
HWY_INLINE std::uint32_t in_range(const std::uint32_t* first_points, PointRange range) {
  const hn::RebindToUnsigned<Floats> d;
  const auto begin = hn::Set(d, range.begin);
  const auto size = hn::Set(d, range.end - range.begin);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(d)) {
    const auto places = hn::Sub(hn::LoadU(d, first_points + lane), begin);
    bits |= bits_of(hn::RebindMask(Floats(), hn::Lt(places, size))) << lane;
  }
  return bits;
}

/// Boxes larger by the bound on all sides.
HWY_INLINE void inflate(const BoxBlock& boxes, float bound, BoxBlock& larger) {
  const auto bounds = hn::Set(Floats(), bound);
  const LaneVector reach{bounds, bounds, bounds};
  for (std::size_t lane = 0; lane < run_width; lane += hn::Lanes(Floats())) {
    store(subtract(load(boxes.lower, lane), reach), larger.lower, lane);
    store(add(load(boxes.upper, lane), reach), larger.upper, lane);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
