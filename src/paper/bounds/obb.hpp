#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/bounds/aabb.hpp"
#include "src/bounds/bounding_volume.hpp"

namespace fiber {

/// Oriented bounding box (paper, Sect. 4.3).
struct Obb {
  using Parameters = NoParameters;

  Eigen::Vector3f center = Eigen::Vector3f::Zero();    ///< [m] relative to the hierarchy's origin
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  ///< columns: orthonormal directions
  Eigen::Vector3f half_extents = Eigen::Vector3f::Zero();  ///< [m]; infinite: everything
};

/// Along the segment.
void fit(Obb& box, const Capsule& capsule, const NoParameters& parameters);

/// Oriented by a principal component analysis of the end points.
void fit(Obb& box, const CapsuleRun& run, const NoParameters& parameters);

/// The second level (Sect. 4.3.1): two segments that share a point span a triangle, whose normal
/// and longest side orient the box; two that do not, at the end of a fibre, are oriented by a
/// principal component analysis of their four points.
Obb merge_leaves(const Obb& a, const Obb& b, const Capsule& capsule_a, const Capsule& capsule_b);

/// The levels above: oriented by a principal component analysis of the 16 corners of the two.
Obb merge(const Obb& a, const Obb& b);

/// Separating axes test; an edge–edge axis of near-parallel boxes is padded, never trusted.
bool overlaps(const Obb& a, const Obb& b, float margin);

/// The widest gap along the six face normals.
float distance_lower_bound(const Obb& a, const Obb& b);

bool contains(const Obb& box, const Capsule& capsule, const NoParameters& parameters);
double volume(const Obb& box, const NoParameters& parameters);
Aabb bounding_box(const Obb& box, const NoParameters& parameters);

/// The box's own axes, longest extent first.
std::vector<SplitAxis> split_axes(const Obb& box, const CapsuleRun& run,
                                  const NoParameters& parameters);

static_assert(IsBoundingVolume<Obb>::value, "Obb must keep the contract");

}  // namespace fiber
