#pragma once

#include <vector>

#include "src/paper/hierarchy/hierarchy.hpp"

namespace fiber {

/// A hierarchy whose nodes are fitted to the segments below them, not to their children: it keeps
/// the segments, relative to the origin, in the order of its leaves.
template <class Volume>
class RunHierarchy : public Hierarchy<Volume> {
 public:
  std::size_t memory_bytes() const {
    return Hierarchy<Volume>::memory_bytes() + order_.capacity() * sizeof(std::uint32_t) +
           capsules_.capacity() * sizeof(Capsule) + runs_.capacity() * sizeof(LeafRun);
  }

 protected:
  using Hierarchy<Volume>::Hierarchy;

  /// Takes the segments' coordinates in the order of `order_`.
  void load_capsules(const FiberAssembly& fibers) {
    capsules_.clear();
    capsules_.reserve(order_.size());
    for (const std::uint32_t point : order_) {
      capsules_.push_back(this->relative_capsule(fibers, point));
    }
  }

  CapsuleRun capsules(const LeafRun& run) const { return {&capsules_[run.begin], run.size()}; }

  std::vector<std::uint32_t> order_;  // segments by the index of their first point
  std::vector<Capsule> capsules_;     // in that order
  std::vector<LeafRun> runs_;         // by node
};

}  // namespace fiber
