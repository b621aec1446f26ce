// A group as traversals compare it. Included once per instruction set, so it has the guard that
// Highway asks for instead of #pragma once.
#if defined(FIBER_PROBE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_PROBE_INL
#undef FIBER_PROBE_INL
#else
#define FIBER_PROBE_INL
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "src/hierarchy/run_lanes-inl.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

/// A group of the one tree while it looks for what is near it in the other: all its boxes, larger
/// by the bound.
template <bool moves>
class Probe {
 public:
  void aim(const RunTreeView& tree, std::uint32_t group, float bound) {
    const std::uint32_t first = group * run_width;
    run_count_ = std::min(run_width, tree.levels[0].child_count - first);
    inflate(tree.levels[0].boxes[group], bound, runs_);
    for (std::uint32_t lane = 0; lane < run_count_; ++lane) {
      fit_boxes<moves>(tree, first + lane, segments_[lane]);
      inflate(segments_[lane], bound, segments_[lane]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      whole_.lower[axis][0] = *std::min_element(runs_.lower[axis], runs_.lower[axis] + run_width);
      whole_.upper[axis][0] = *std::max_element(runs_.upper[axis], runs_.upper[axis] + run_width);
    }
  }

  std::uint32_t run_count() const { return run_count_; }
  const BoxBlock& whole() const { return whole_; }  ///< in lane 0
  const BoxBlock& runs() const { return runs_; }
  const BoxBlock& segments(std::uint32_t run) const { return segments_[run]; }

 private:
  std::uint32_t run_count_ = 0;
  BoxBlock whole_ = {};
  BoxBlock runs_ = {};
  BoxBlock segments_[run_width] = {};
};

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
