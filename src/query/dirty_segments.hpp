#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/hierarchy/run_tree.hpp"

namespace fiber {

/// The segments of fibres that have moved so far that the candidates kept of them no longer serve,
/// with a run tree of their own to look for others. Keeps its memory.
class DirtySegments {
 public:
  void clear();

  /// Adds the segments of this fibre unless they are there.
  void add(const FiberAssembly& fibers, std::uint32_t fiber);

  /// Fits the tree to the segments there are; to be called when all are added.
  void fit(const FiberAssembly& fibers, const Eigen::Vector3d& origin);

  std::size_t size() const { return first_points_.size(); }

  /// Of a segment by its first point.
  bool contains(std::uint32_t first_point) const { return is_outdated_[first_point] != 0; }

  const RunTreeView& tree() const { return tree_.view(); }
  std::size_t memory_bytes() const;

 private:
  std::vector<std::uint32_t> first_points_;
  std::vector<std::uint8_t> is_outdated_;  // by first point
  RunTree tree_;
};

}  // namespace fiber
