#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"

namespace fiber {

/// The fast hierarchy: segments along a space-filling curve, refitted in place while that order
/// serves.
///
/// Leaves are runs of eight segments that follow each other along the curve: of one fibre where
/// fibres are alone, of neighbouring fibres where they are dense. Over them lies a tree of eight
/// children per node, without pointers, in level order. An update refits all boxes in place; only
/// when they have grown by more than `max_decay` since the last sort are segments sorted anew.
class FIBER_PROXIMITY_EXPORT RunTree {
 public:
  RunTree() = default;
  RunTree(const RunTree&) = delete;  // the view points into it
  RunTree& operator=(const RunTree&) = delete;
  ~RunTree() = default;

  /// By how much the boxes of runs may grow, relative to those of their segments, before segments
  /// are sorted anew (docs/performance.md).
  static constexpr double max_decay = 1.5;

  void build(const TreeFibers& fibers);

  /// Builds a tree of some segments only.
  /// @param first_points of the segments, all different
  void build(const TreeFibers& fibers, const std::vector<std::uint32_t>& first_points);

  /// Refits a tree of all segments to moved points of the same topology; sorts anew first if the
  /// order has decayed.
  void update(const TreeFibers& fibers);

  const RunTreeView& view() const { return view_; }
  const Eigen::Vector3d& origin() const { return origin_; }              ///< before a motion
  const Eigen::Vector3d& origin_after() const { return origin_after_; }  ///< the same without one

  /// Whether its fibres move.
  bool moves() const { return view_.displacements != nullptr; }

  /// Whether some segments are beyond the range of float.
  bool is_unbounded() const;

  /// How often segments have been sorted since the tree was built.
  std::uint64_t sort_count() const { return sort_count_; }
  std::size_t memory_bytes() const;

 private:
  void sort(const FiberAssembly& fibers);
  void find_min_points();
  void refit(const TreeFibers& fibers);
  double looseness(const FiberAssembly& fibers);
  void set_view();

  std::vector<std::uint32_t> first_points_;  // of segments, in the order of the curve; whole runs
  std::uint32_t segment_count_ = 0;
  std::vector<Run> runs_;
  std::vector<RunDisplacement> displacements_;  // empty until something moves
  std::vector<std::vector<BoxBlock>> levels_;   // boxes of the children, by node; groups first
  std::vector<std::vector<std::uint32_t>> min_points_;  // of the children, by node
  std::vector<std::uint64_t> keys_;                     // of sort()
  std::vector<std::uint64_t> scratch_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d origin_after_ = Eigen::Vector3d::Zero();
  double sorted_looseness_ = 0.0;
  std::uint64_t sort_count_ = 0;
  RunTreeView view_;
};

}  // namespace fiber
