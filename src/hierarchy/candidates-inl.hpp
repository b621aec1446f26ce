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

#include "fiber_proximity/hierarchy/run_tree_kernels.hpp"
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

/// Pairs of segments whose boxes are near, on their way to the sink: few of the lanes of two runs
/// are, so they are brought together to fill registers.
class Candidates {
 public:
  Candidates(const RunTreeView& a, const RunTreeView& b, PairSink& sink)
      : runs_a_(a.runs), runs_b_(b.runs), spans_a_(a.spans), spans_b_(b.spans), sink_(sink) {}

  /// Room for all pairs of two runs; whether the sink wants to go on.
  bool make_room() { return size_ + run_width * run_width <= capacity || flush(); }

  void push(std::uint32_t run_a, std::uint32_t i, std::uint32_t run_b, std::uint32_t j,
            float reach) {
    a_[size_] = static_cast<std::int32_t>(run_a * floats_per_run + i);
    b_[size_] = static_cast<std::int32_t>(run_b * floats_per_run + j);
    reach_[size_] = reach;
    pairs_[size_] = {spans_a_[run_a].first_point + i, spans_b_[run_b].first_point + j};
    ++size_;
  }

  /// Hands the pairs that are near to the sink; whether it wants to go on.
  bool flush() {
    const Floats d;
    const std::uint32_t size = size_;
    size_ = 0;
    std::fill_n(a_ + size, run_width, 0);
    std::fill_n(b_ + size, run_width, 0);
    for (std::uint32_t first = 0; first < size; first += static_cast<std::uint32_t>(hn::Lanes(d))) {
      const auto close = near(gather(runs_a_, a_ + first), gather(runs_b_, b_ + first),
                              hn::LoadU(d, reach_ + first));
      std::uint32_t bits = bits_of(close) & first_bits(std::min(run_width, size - first));
      while (bits != 0) {
        if (!sink_.offer(pairs_[first + take_lowest(bits)])) {
          return false;
        }
      }
    }
    return true;
  }

 private:
  static constexpr std::uint32_t capacity = 512;
  static constexpr std::uint32_t floats_per_run = sizeof(Run) / sizeof(float);

  static LaneVector gather_point(const float* first, const std::int32_t* indices) {
    const Floats d;
    const auto index = hn::LoadU(hn::RebindToSigned<Floats>(), indices);
    constexpr std::uint32_t stride = run_width + 1;
    return {hn::GatherIndex(d, first, index), hn::GatherIndex(d, first + stride, index),
            hn::GatherIndex(d, first + 2 * stride, index)};
  }

  static LaneSegments gather(const Run* runs, const std::int32_t* indices) {
    static_assert(std::is_standard_layout_v<Run>, "runs are read as arrays of floats");
    const float* const first = runs->x;
    return lane_segments(gather_point(first, indices), gather_point(first + 1, indices));
  }

  const Run* const runs_a_;
  const Run* const runs_b_;
  const RunSpan* const spans_a_;
  const RunSpan* const spans_b_;
  PairSink& sink_;
  std::uint32_t size_ = 0;
  std::int32_t a_[capacity + run_width];  // where the segment's x is among all floats
  std::int32_t b_[capacity + run_width];
  float reach_[capacity + run_width] = {};
  PointPair pairs_[capacity];
};

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
