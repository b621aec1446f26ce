#include <algorithm>
#include <cmath>

#include "src/hierarchy/fiber_order.hpp"
#include "src/paper/hierarchy/hierarchy.hpp"

namespace fiber {
namespace {

/// A basis stands if its sphere misses by no more than its own rounding; the volume's padding of
/// 2⁻²⁰ takes that in.
constexpr double enclosure_tolerance = 1.0 + 1e-12;

}  // namespace

void CascadedHierarchy::build(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
  order_ = end_point_connected_order(fibers.offsets());
  tree_.build(order_, SplitInMiddle(), &runs_);
  volumes_.resize(tree_.node_count());
  radii_.resize(tree_.node_count());
  // Without bases no sphere stands: the update computes them all.
  spheres_.assign(tree_.node_count(), MinimalSphere());
  update(fibers, origin);
}

void CascadedHierarchy::update(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
  origin_ = origin;
  points_.clear();
  for (const Eigen::Vector3d& point : fibers.points()) {
    points_.push_back(point - origin);
  }
  recomputed_ = 0;
  for (std::uint32_t node = tree_.node_count(); node-- > 0;) {
    if (tree_.is_leaf(node)) {
      spheres_[node] = sphere_of_run(runs_[node]);
      radii_[node] = fibers.segment_radius(tree_.leaf_point(node));
    } else {
      const std::uint32_t child = tree_.first_child(node);
      radii_[node] = std::max(radii_[child], radii_[child + 1]);
      const MinimalSphere candidate = sphere_of_basis(spheres_[node]);
      if (encloses(candidate, child) && encloses(candidate, child + 1)) {
        spheres_[node] = candidate;
      } else {
        ++recomputed_;
        spheres_[node] = sphere_of_run(runs_[node]);
      }
    }
    set_volume(node);
  }
}

std::size_t CascadedHierarchy::memory_bytes() const {
  return Hierarchy::memory_bytes() + order_.capacity() * sizeof(std::uint32_t) +
         runs_.capacity() * sizeof(LeafRun) + points_.capacity() * sizeof(Eigen::Vector3d) +
         spheres_.capacity() * sizeof(MinimalSphere) + radii_.capacity() * sizeof(double);
}

bool CascadedHierarchy::encloses(const MinimalSphere& sphere, std::uint32_t node) const {
  const MinimalSphere& inner = spheres_[node];
  const double reach =
      (inner.center - sphere.center).norm() + std::sqrt(std::max(inner.squared_radius, 0.0));
  if (reach * reach <= sphere.squared_radius * enclosure_tolerance) {
    return true;
  }
  if (tree_.is_leaf(node)) {
    const std::uint32_t point = tree_.leaf_point(node);
    const double farthest = std::max((points_[point] - sphere.center).squaredNorm(),
                                     (points_[point + 1] - sphere.center).squaredNorm());
    return farthest <= sphere.squared_radius * enclosure_tolerance;
  }
  // As deep as the balanced tree is high.
  const std::uint32_t child = tree_.first_child(node);
  return encloses(sphere, child) && encloses(sphere, child + 1);
}

MinimalSphere CascadedHierarchy::sphere_of_run(const LeafRun& run) {
  scratch_.clear();
  std::uint32_t previous = order_[run.begin];
  for (std::uint32_t i = run.begin; i < run.end; ++i) {
    // Neighbours on a fibre share a point: it is taken once.
    const std::uint32_t point = order_[i];
    if (i == run.begin || point != previous + 1) {
      scratch_.push_back(point);
    }
    if (i == run.begin || point + 1 != previous) {
      scratch_.push_back(point + 1);
    }
    previous = point;
  }
  return minimal_sphere(points_, scratch_);
}

MinimalSphere CascadedHierarchy::sphere_of_basis(const MinimalSphere& old) {
  scratch_.assign(old.basis.begin(), old.basis.begin() + old.basis_size);
  return minimal_sphere(points_, scratch_);
}

void CascadedHierarchy::set_volume(std::uint32_t node) {
  const MinimalSphere& sphere = spheres_[node];
  // A capsule of no length at the centre, as thick as the sphere: the padding is the volume's own.
  const double reach = std::sqrt(std::max(sphere.squared_radius, 0.0)) + radii_[node];
  fit(volumes_[node], Capsule{sphere.center, sphere.center, reach}, parameters_);
}

}  // namespace fiber
