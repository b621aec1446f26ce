#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/bounds/bounding_volume.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/hierarchy/binary_tree.hpp"
#include "fiber_proximity/hierarchy/fiber_order.hpp"

namespace fiber {

/// The paper's layered chain-aligned hierarchy (Sect. 3): a balanced binary tree over the
/// end-point-connected order, each node's volume merged from its two children's.
template <class Volume>
class Hierarchy {
  static_assert(IsBoundingVolume<Volume>::value, "see bounding_volume.hpp");

 public:
  /// Builds the tree for the fibres' topology and fits the volumes.
  /// @param origin [m] the point all volumes are relative to; trees that are traversed together
  ///        need the same one
  void build(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
    tree_ = BinaryTree::balanced(end_point_connected_order(fibers.offsets()));
    volumes_.resize(tree_.node_count());
    update(fibers, origin);
  }

  /// Refits all volumes bottom-up (Sect. 3.3) to moved points of the same topology; allocates
  /// nothing.
  void update(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
    origin_ = origin;
    for (std::uint32_t node = tree_.node_count(); node-- > 0;) {
      if (tree_.is_leaf(node)) {
        const std::uint32_t point = tree_.leaf_point(node);
        const std::vector<Eigen::Vector3d>& points = fibers.points();
        fit(volumes_[node], Capsule{points[point] - origin, points[point + 1] - origin,
                                    fibers.segment_radius(point)});
      } else {
        const std::uint32_t child = tree_.first_child(node);
        volumes_[node] = merge(volumes_[child], volumes_[child + 1]);
      }
    }
  }

  const BinaryTree& tree() const { return tree_; }
  const Volume& volume(std::uint32_t node) const { return volumes_[node]; }
  const Eigen::Vector3d& origin() const { return origin_; }

 private:
  BinaryTree tree_;
  std::vector<Volume> volumes_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
};

}  // namespace fiber
