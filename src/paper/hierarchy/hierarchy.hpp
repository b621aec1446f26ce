#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/bounds/bounding_volume.hpp"
#include "src/hierarchy/fiber_order.hpp"
#include "src/paper/bounds/sphere.hpp"
#include "src/paper/hierarchy/binary_tree.hpp"

namespace fiber {

/// A binary tree of volumes over the segments of an assembly: what a traversal sees. The kinds of
/// hierarchy (layered, wrapped, spatial) differ in how they build and update it.
template <class VolumeType>
class Hierarchy {
  static_assert(IsBoundingVolume<VolumeType>::value, "see bounding_volume.hpp");

 public:
  using Volume = VolumeType;
  using Parameters = typename Volume::Parameters;

  const BinaryTree& tree() const { return tree_; }
  const Volume& volume(std::uint32_t node) const { return volumes_[node]; }

  /// The origin of all volumes [m]; hierarchies that are traversed together share it.
  const Eigen::Vector3d& origin() const { return origin_; }
  const Parameters& parameters() const { return parameters_; }

  /// Memory of tree and volumes [bytes]; kinds that keep more add to it.
  std::size_t memory_bytes() const {
    return tree_.memory_bytes() + volumes_.capacity() * sizeof(Volume);
  }

  /// How many volumes the last update computed anew; kinds that keep some hide this.
  std::uint64_t recomputed_count() const { return tree_.node_count(); }

 protected:
  explicit Hierarchy(const Parameters& parameters) : parameters_(parameters) {}

  /// The segment that starts at this point, relative to the origin.
  Capsule relative_capsule(const FiberAssembly& fibers, std::uint32_t point) const {
    return {fibers.points()[point] - origin_, fibers.points()[point + 1] - origin_,
            fibers.segment_radius(point)};
  }

  BinaryTree tree_;
  std::vector<Volume> volumes_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Parameters parameters_;
};

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

/// The wrapped hierarchy of spheres, SW, updated by the cascade verification of Guibas et al.
/// (paper, Sect. 3.3): a node's minimal sphere is described by at most four basis points. When the
/// points have moved, the sphere of the old basis stands if it still encloses all of them, which
/// the spheres further down usually prove; only where they do not is it computed anew.
class CascadedHierarchy : public Hierarchy<Sphere> {
 public:
  explicit CascadedHierarchy(const NoParameters& parameters = {}) : Hierarchy(parameters) {}

  /// @param origin [m] the point all volumes are relative to
  void build(const FiberAssembly& fibers, const Eigen::Vector3d& origin);
  void update(const FiberAssembly& fibers, const Eigen::Vector3d& origin);

  std::size_t memory_bytes() const;

  /// How many nodes' bases the last update had to compute anew.
  std::uint64_t recomputed_count() const { return recomputed_; }

 private:
  /// Whether the sphere encloses all points below the node.
  bool encloses(const MinimalSphere& sphere, std::uint32_t node) const;
  MinimalSphere sphere_of_run(const LeafRun& run);
  MinimalSphere sphere_of_basis(const MinimalSphere& old);
  void set_volume(std::uint32_t node);

  std::vector<std::uint32_t> order_;     // segments by the index of their first point
  std::vector<LeafRun> runs_;            // by node
  std::vector<Eigen::Vector3d> points_;  // relative to the origin [m]
  std::vector<MinimalSphere> spheres_;   // by node, of the points alone
  std::vector<double> radii_;            // by node, of the thickest fibre below it [m]
  std::vector<std::uint32_t> scratch_;
  std::uint64_t recomputed_ = 0;
};

}  // namespace fiber
