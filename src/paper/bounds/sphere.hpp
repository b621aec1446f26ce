#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/bounds/aabb.hpp"
#include "src/bounds/bounding_volume.hpp"

namespace fiber {

/// Bounding sphere (paper, Sect. 4.4).
struct Sphere {
  using Parameters = NoParameters;

  Eigen::Vector3f center = Eigen::Vector3f::Zero();  ///< [m] relative to the hierarchy's origin
  float radius = 0.0F;                               ///< [m]; infinite: everything
};

void fit(Sphere& sphere, const Capsule& capsule, const NoParameters& parameters);

/// The minimal enclosing sphere of the end points (Welzl), widened by the largest radius; minimal
/// when the radii are equal, as the paper requires of them.
void fit(Sphere& sphere, const CapsuleRun& run, const NoParameters& parameters);

/// Fits around a given centre [m]: radius by the farthest end point, so that any centre will do.
void fit_around(Sphere& sphere, const Eigen::Vector3d& center, const CapsuleRun& run);

/// The smallest sphere around both.
Sphere merge(const Sphere& a, const Sphere& b);

bool overlaps(const Sphere& a, const Sphere& b, float margin);
float distance_lower_bound(const Sphere& a, const Sphere& b);

bool contains(const Sphere& sphere, const Capsule& capsule, const NoParameters& parameters);
double volume(const Sphere& sphere, const NoParameters& parameters);
Aabb bounding_box(const Sphere& sphere, const NoParameters& parameters);

/// A sphere has no axes: those of the box around the capsules.
std::vector<SplitAxis> split_axes(const Sphere& sphere, const CapsuleRun& run,
                                  const NoParameters& parameters);

static_assert(IsBoundingVolume<Sphere>::value, "Sphere must keep the contract");

}  // namespace fiber
