// Pairs of segments between the tests of their boxes and of their distance.
// Included once per instruction set, so it has the guard that Highway asks for.
#if defined(FIBER_CANDIDATES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_CANDIDATES_INL
#undef FIBER_CANDIDATES_INL
#else
#define FIBER_CANDIDATES_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <type_traits>

#include "src/hierarchy/run_lanes-inl.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/hierarchy/segment_lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

constexpr std::uint32_t first_bits(std::uint32_t count) { return (1U << count) - 1U; }

HWY_INLINE std::uint32_t take_lowest(std::uint32_t& bits) {
  const auto lane = static_cast<std::uint32_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(bits));
  bits &= bits - 1;
  return lane;
}

HWY_INLINE std::uint32_t take_highest(std::uint32_t& bits) {
  const auto lane = 31U - static_cast<std::uint32_t>(hwy::Num0BitsAboveMS1Bit_Nonzero32(bits));
  bits ^= 1U << lane;
  return lane;
}

/// Pairs of segments whose boxes and lines are near, on their way to the sink: few of the lanes of
/// two runs are, so they are brought together to fill registers.
class Candidates {
 public:
  Candidates(const RunTreeView& a, const RunTreeView& b, PairSink& sink)
      : a_(a), b_(b), sink_(sink) {}

  /// Room for all pairs of two runs; whether the sink wants to go on.
  bool make_room() { return size_ + run_width * run_width <= capacity || flush(); }

  /// Segments by their places along the curve.
  void push(std::uint32_t a, std::uint32_t b) {
    places_a_[size_] = static_cast<std::int32_t>(a);
    places_b_[size_] = static_cast<std::int32_t>(b);
    ++size_;
  }

  /// Hands the pairs that are near to the sink; whether it wants to go on.
  bool flush() {
    const Floats d;
    const std::uint32_t size = size_;
    size_ = 0;
    std::fill_n(places_a_ + size, run_width, 0);
    std::fill_n(places_b_ + size, run_width, 0);
    for (std::uint32_t first = 0; first < size; first += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const GatheredSegments a = gather(a_.runs, places_a_ + first);
      const GatheredSegments b = gather(b_.runs, places_b_ + first);
      const auto reach = hn::Add(hn::Add(a.radius, b.radius), hn::Set(d, sink_.bound().gap));
      const auto may_be_close =
          a_.displacements == nullptr
              ? segments_near(a.segments, b.segments, reach)
              : MovingPairs(a.segments, b.segments,
                            subtract(gather(a_.displacements, places_a_ + first),
                                     gather(b_.displacements, places_b_ + first)),
                            reach)
                    .are_near();
      // Where the bound is a depth, those that are thinner than that have none.
      const auto close = hn::And(may_be_close, hn::Ge(reach, hn::Zero(d)));
      std::uint32_t bits = bits_of(close) & first_bits(std::min(run_width, size - first));
      while (bits != 0) {
        const std::uint32_t i = first + take_lowest(bits);
        if (!sink_.offer({a_.first_points[places_a_[i]], b_.first_points[places_b_[i]]})) {
          return false;
        }
      }
    }
    return true;
  }

 private:
  static constexpr std::uint32_t capacity = 512;

  struct GatheredSegments {
    LaneSegments segments;
    Lanes radius;
  };

  static GatheredSegments gather(const Run* runs, const std::int32_t* places) {
    static_assert(std::is_standard_layout_v<Run>, "runs are read as arrays of floats");
    const Rows rows(runs->start[0], sizeof(Run) / sizeof(float), places);
    return {lane_segments({rows[0], rows[1], rows[2]}, {rows[3], rows[4], rows[5]}), rows[6]};
  }

  static LaneVector gather(const RunDisplacement* displacements, const std::int32_t* places) {
    static_assert(std::is_standard_layout_v<RunDisplacement>,
                  "displacements are read as arrays of floats");
    const Rows rows(displacements->half[0], sizeof(RunDisplacement) / sizeof(float), places);
    return {rows[0], rows[1], rows[2]};
  }

  /// Rows of eight floats, some to a run: of each its part of some segments, one a lane.
  class Rows {
   public:
    Rows(const float* first, std::int32_t floats_per_run, const std::int32_t* places)
        : first_(first) {
      // Where the segment's first float is among all floats: run · floats_per_run + lane.
      const Integers d;
      const auto place = hn::LoadU(d, places);
      const auto run = hn::ShiftRight<3>(place);
      index_ = hn::Add(place, hn::Mul(run, hn::Set(d, floats_per_run - std::int32_t{run_width})));
    }

    HWY_INLINE Lanes operator[](std::size_t row) const {
      return hn::GatherIndex(Floats(), first_ + row * run_width, index_);
    }

   private:
    using Integers = hn::RebindToSigned<Floats>;

    const float* const first_;
    hn::Vec<Integers> index_;
  };

  const RunTreeView& a_;
  const RunTreeView& b_;
  PairSink& sink_;
  std::uint32_t size_ = 0;
  std::int32_t places_a_[capacity + run_width];
  std::int32_t places_b_[capacity + run_width];
};

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
