#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/hierarchy/run_blocks.hpp"

namespace fiber {

/// The fast hierarchy: chain-aligned at the bottom, spatially sorted above.
///
/// Leaves are runs of up to eight consecutive segments of one fibre, which stay small however the
/// fibres move. Runs stand along a space-filling curve; over them lies a tree of eight children per
/// node, without pointers, in level order. An update refits all boxes in place; only when they have
/// grown by more than `most_decay` since the last sort are the runs sorted anew.
class RunTree {
 public:
  RunTree() = default;
  RunTree(const RunTree&) = delete;  // the view points into it
  RunTree& operator=(const RunTree&) = delete;
  ~RunTree() = default;

  /// By how much the boxes of groups may grow, relative to those of their runs, before runs are
  /// sorted anew (docs/performance.md).
  static constexpr double most_decay = 1.5;

  /// @param origin [m] the point all boxes are relative to
  void build(const FiberAssembly& fibers, const Eigen::Vector3d& origin);

  /// Refits to moved points of the same topology, and sorts anew if the order has decayed.
  void update(const FiberAssembly& fibers, const Eigen::Vector3d& origin);

  const RunTreeView& view() const { return view_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  std::uint32_t run_count() const { return static_cast<std::uint32_t>(spans_.size()); }

  /// How often runs have been sorted since the tree was built.
  std::uint64_t sort_count() const { return sort_count_; }
  std::size_t memory_bytes() const;

 private:
  void sort(const FiberAssembly& fibers);
  void refit(const FiberAssembly& fibers);
  double looseness() const;
  void set_view();

  struct Place {
    std::uint64_t key;
    RunSpan span;
  };

  struct Level {
    std::vector<BoxBlock> boxes;  // of the children, by node
    std::vector<CapsuleBlock> capsules;
  };

  std::vector<RunSpan> spans_;  // in the order of the curve
  std::vector<Run> runs_;
  std::vector<BoxBlock> segment_boxes_;  // by run
  std::vector<Level> levels_;            // groups first
  std::vector<Place> places_;            // scratch of sort()
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double sorted_looseness_ = 0.0;
  std::uint64_t sort_count_ = 0;
  RunTreeView view_;
};

}  // namespace fiber
