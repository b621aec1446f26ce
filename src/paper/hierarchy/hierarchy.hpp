#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/bounds/bounding_volume.hpp"
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

  /// What all volumes are relative to [m]; hierarchies that are traversed together share it.
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
  ~Hierarchy() = default;
  Hierarchy(const Hierarchy&) = default;
  Hierarchy(Hierarchy&&) noexcept = default;
  Hierarchy& operator=(const Hierarchy&) = default;
  Hierarchy& operator=(Hierarchy&&) noexcept = default;

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

}  // namespace fiber
