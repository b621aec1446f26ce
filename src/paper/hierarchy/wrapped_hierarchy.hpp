#pragma once

#include "src/hierarchy/fiber_order.hpp"
#include "src/paper/hierarchy/run_hierarchy.hpp"

namespace fiber {

/// The paper's wrapped chain-aligned hierarchy (Sect. 3): the layered one's tree, but each node's
/// volume is fitted to the sub-chain below it. Updated top-down, in full, in O(n log n)
/// (Sect. 3.3).
template <class Volume>
class WrappedHierarchy : public RunHierarchy<Volume> {
 public:
  explicit WrappedHierarchy(const typename Volume::Parameters& parameters = {})
      : RunHierarchy<Volume>(parameters) {}

  /// @param origin [m] the point all volumes are relative to
  void build(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
    this->order_ = end_point_connected_order(fibers.offsets());
    this->tree_.build(this->order_, SplitInMiddle(), &this->runs_);
    this->volumes_.resize(this->tree_.node_count());
    update(fibers, origin);
  }

  void update(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
    this->origin_ = origin;
    this->load_capsules(fibers);
    for (std::uint32_t node = 0; node < this->tree_.node_count(); ++node) {
      if (this->tree_.is_leaf(node)) {
        fit(this->volumes_[node], this->capsules_[this->runs_[node].begin], this->parameters_);
      } else {
        fit(this->volumes_[node], this->capsules(this->runs_[node]), this->parameters_);
      }
    }
  }
};

}  // namespace fiber
