#pragma once

#include <algorithm>
#include <vector>

#include "src/hierarchy/fiber_order.hpp"
#include "src/paper/hierarchy/run_hierarchy.hpp"

namespace fiber {

/// The paper's spatially adapted hierarchy (Sect. 3.1): the segments are divided top-down, each
/// node in the middle of its volume's longest axis; where that leaves one side empty, along the
/// next axis; where none divides them, at the projection of their barycentre onto the axes in turn;
/// and where they all have one centre, which the paper calls numerically impossible, by index. An
/// update divides anew (Sect. 3.3).
template <class Volume>
class SpatialHierarchy : public RunHierarchy<Volume> {
 public:
  explicit SpatialHierarchy(const typename Volume::Parameters& parameters = {})
      : RunHierarchy<Volume>(parameters) {}

  /// @param origin [m] the point all volumes are relative to
  void build(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
    this->origin_ = origin;
    this->order_ = end_point_connected_order(fibers.offsets());
    this->load_capsules(fibers);
    this->volumes_.resize(this->order_.empty() ? 0 : 2 * this->order_.size() - 1);
    this->tree_.build(
        this->order_,
        [this](std::uint32_t node, const LeafRun& run) {
          fit(this->volumes_[node], this->capsules(run), this->parameters_);
          return divide(node, run);
        },
        &this->runs_);
    for (std::uint32_t node = 0; node < this->tree_.node_count(); ++node) {
      if (this->tree_.is_leaf(node)) {
        fit(this->volumes_[node], this->capsules_[this->runs_[node].begin], this->parameters_);
      }
    }
  }

  void update(const FiberAssembly& fibers, const Eigen::Vector3d& origin) { build(fibers, origin); }

 private:
  static Eigen::Vector3d center(const Capsule& capsule) {
    return 0.5 * capsule.p0 + 0.5 * capsule.p1;
  }

  std::uint32_t divide(std::uint32_t node, const LeafRun& run) {
    const std::vector<SplitAxis> axes =
        split_axes(this->volumes_[node], this->capsules(run), this->parameters_);
    for (const SplitAxis& axis : axes) {
      const std::uint32_t middle = partition(run, axis.direction, axis.middle);
      if (middle != run.begin && middle != run.end) {
        return middle;
      }
    }
    Eigen::Vector3d barycentre = Eigen::Vector3d::Zero();
    for (const Capsule& capsule : this->capsules(run)) {
      barycentre += center(capsule) / static_cast<double>(run.size());
    }
    for (const SplitAxis& axis : axes) {
      const std::uint32_t middle = partition(run, axis.direction, axis.direction.dot(barycentre));
      if (middle != run.begin && middle != run.end) {
        return middle;
      }
    }
    return SplitInMiddle()(node, run);
  }

  /// Moves the segments whose centres lie below `position` [m] along the direction to the front of
  /// the run; the others keep their order behind them.
  /// @return where the others begin
  std::uint32_t partition(const LeafRun& run, const Eigen::Vector3d& direction, double position) {
    moved_order_.clear();
    moved_capsules_.clear();
    std::uint32_t front = run.begin;
    for (std::uint32_t i = run.begin; i < run.end; ++i) {
      if (direction.dot(center(this->capsules_[i])) < position) {
        this->order_[front] = this->order_[i];
        this->capsules_[front] = this->capsules_[i];
        ++front;
      } else {
        moved_order_.push_back(this->order_[i]);
        moved_capsules_.push_back(this->capsules_[i]);
      }
    }
    std::copy(moved_order_.begin(), moved_order_.end(), this->order_.begin() + front);
    std::copy(moved_capsules_.begin(), moved_capsules_.end(), this->capsules_.begin() + front);
    return front;
  }

  std::vector<std::uint32_t> moved_order_;
  std::vector<Capsule> moved_capsules_;
};

}  // namespace fiber
