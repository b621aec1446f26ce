#pragma once

#include <cstdint>

namespace fiber {

/// Segments in a full run, and children of a full node: the lanes of one AVX register of floats.
constexpr std::uint32_t run_width = 8;

/// Up to eight consecutive segments of one fibre, their points as a structure of arrays. Behind the
/// last point stand copies of it.
struct Run {
  float x[run_width + 1];  ///< [m] relative to the tree's origin
  float y[run_width + 1];
  float z[run_width + 1];
  /// Of the thickest segment, padded so that every test on this run errs on the safe side [m].
  float radius;
};

/// Which segments a run holds.
struct RunSpan {
  std::uint32_t first_point;
  std::uint32_t segment_count;
};

/// Boxes of up to eight segments, runs or nodes [m]; by axis, then lane.
struct alignas(32) BoxBlock {
  float lower[3][run_width];
  float upper[3][run_width];
};

/// Capsules around up to eight runs or nodes [m]; by axis, then lane. That of a run has the run's
/// chord for its axis. Along bundles of hair they separate what boxes do not.
struct alignas(32) CapsuleBlock {
  float start[3][run_width];
  float end[3][run_width];
  float radius[run_width];
};

/// Nodes of one level. Level 0 are groups, whose children are runs; the children of node n are
/// 8n … 8n + 7 one level down, as far as there are so many.
struct RunTreeLevel {
  const BoxBlock* boxes;         ///< of the children, by node
  const CapsuleBlock* capsules;  ///< of the children, by node
  std::uint32_t node_count;
  std::uint32_t child_count;  ///< of all nodes of the level
};

/// What the kernels see of a tree.
struct RunTreeView {
  static constexpr std::uint32_t most_levels = 11;  // 8^11 runs are more than there can be

  const Run* runs = nullptr;
  const RunSpan* spans = nullptr;
  const BoxBlock* segment_boxes = nullptr;  ///< by run
  RunTreeLevel levels[most_levels] = {};
  std::uint32_t level_count = 0;

  std::uint32_t group_count() const { return level_count == 0 ? 0 : levels[0].node_count; }
};

}  // namespace fiber
