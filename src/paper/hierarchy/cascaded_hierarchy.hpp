#pragma once

#include <cstdint>
#include <vector>

#include "src/paper/bounds/minimal_sphere.hpp"
#include "src/paper/bounds/sphere.hpp"
#include "src/paper/hierarchy/hierarchy.hpp"

namespace fiber {

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
