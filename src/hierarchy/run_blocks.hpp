#pragma once

#include <cstdint>

namespace fiber {

/// Segments in a run, and children of a node: the lanes of one AVX register of floats.
constexpr std::uint32_t run_width = 8;

/// Eight segments that follow each other along the space-filling curve [m], relative to the tree's
/// origin; by axis, then lane. Lanes without a segment repeat the last one.
struct alignas(32) Run {
  float start[3][run_width];
  float end[3][run_width];
  /// Padded so that every test on these segments errs on the safe side; infinite for a segment
  /// beyond the range of float, which is near everything.
  float radius[run_width];
};

/// How far the eight segments of a run move [m]: from that much before where the run has them to as
/// much beyond, all points of a segment alike; by how much they do not, its radius is larger.
struct alignas(32) RunWays {
  float half[3][run_width];
};

/// Boxes of eight segments, runs or nodes [m]; by axis, then lane. Lanes without a child repeat the
/// last one.
struct alignas(32) BoxBlock {
  float lower[3][run_width];
  float upper[3][run_width];
};

/// Nodes of one level. Level 0 are groups, whose children are runs; the children of node n are
/// 8n … 8n + 7 one level down, as far as there are so many.
struct RunTreeLevel {
  const BoxBlock* boxes;  ///< of the children, by node
  std::uint32_t node_count;
  std::uint32_t child_count;  ///< of all nodes of the level
};

/// What the kernels see of a tree.
struct RunTreeView {
  static constexpr std::uint32_t most_levels = 11;  // 8^11 runs are more than there can be

  const Run* runs = nullptr;
  const RunWays* ways = nullptr;  ///< of the runs; none where nothing moves
  /// Of the segments, along the curve; lanes without a segment repeat the last.
  const std::uint32_t* first_points = nullptr;
  std::uint32_t segment_count = 0;
  RunTreeLevel levels[most_levels] = {};
  std::uint32_t level_count = 0;

  std::uint32_t group_count() const { return level_count == 0 ? 0 : levels[0].node_count; }
};

}  // namespace fiber
