#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "src/bounds/aabb.hpp"
#include "src/bounds/bounding_volume.hpp"

namespace fiber {

/// The minimal enclosing sphere of points and the at most four of them that define it.
struct MinimalSphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m]
  double squared_radius = -1.0;                      ///< [m²]; negative: of no points

  std::array<std::uint32_t, 4> basis{};  ///< indices of the defining points
  std::uint32_t basis_size = 0;
};

/// Welzl's algorithm in its iterative move-to-front form, without recursion over the points. Its
/// time is linear only where points come in no order of theirs (points along a line are quadratic),
/// so it shuffles them first, always the same way: the same points give the same sphere.
/// @param order indices of the points to enclose; reordered, defining points first
MinimalSphere minimal_sphere(const std::vector<Eigen::Vector3d>& points,
                             std::vector<std::uint32_t>& order);

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
