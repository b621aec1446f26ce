#pragma once

#include "src/hierarchy/fiber_order.hpp"
#include "src/paper/hierarchy/hierarchy.hpp"

namespace fiber {

/// The paper's layered chain-aligned hierarchy (Sect. 3): a balanced binary tree over an order of
/// the segments that follows the fibres, each node's volume merged from its two children's.
template <class Volume>
class LayeredHierarchy : public Hierarchy<Volume> {
 public:
  explicit LayeredHierarchy(const typename Volume::Parameters& parameters = {},
                            FiberOrder order = end_point_connected_order)
      : Hierarchy<Volume>(parameters), order_(order) {}

  /// Builds the tree for the fibres' topology and fits the volumes.
  /// @param origin [m] the point all volumes are relative to
  /// @throws std::invalid_argument if the order cannot be had of these fibres
  void build(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
    this->tree_.build(order_(fibers.offsets()), SplitInMiddle());
    this->volumes_.resize(this->tree_.node_count());
    update(fibers, origin);
  }

  /// Refits all volumes bottom-up (Sect. 3.3) to moved points of the same topology; allocates
  /// nothing.
  void update(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
    this->origin_ = origin;
    if (!this->tree_.empty()) {
      refit(fibers, 0);
    }
  }

 private:
  /// Depth first: children are merged while they are in the cache, and each level is still written
  /// in order.
  void refit(const FiberAssembly& fibers, std::uint32_t node) {
    const BinaryTree& tree = this->tree_;
    std::vector<Volume>& volumes = this->volumes_;
    if (tree.is_leaf(node)) {
      fit(volumes[node], this->relative_capsule(fibers, tree.leaf_point(node)), this->parameters_);
      return;
    }
    const std::uint32_t left = tree.first_child(node);
    const std::uint32_t right = left + 1;
    refit(fibers, left);
    refit(fibers, right);
    if (tree.is_leaf(left) && tree.is_leaf(right)) {
      volumes[node] = merge_leaves(volumes[left], volumes[right],
                                   this->relative_capsule(fibers, tree.leaf_point(left)),
                                   this->relative_capsule(fibers, tree.leaf_point(right)));
    } else {
      volumes[node] = merge(volumes[left], volumes[right]);
    }
  }

  FiberOrder order_;
};

}  // namespace fiber
