#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "src/scenes/portable_math.hpp"

namespace fiber {

/// The head that the hair styles grow on: an ellipsoid at the origin; x forward, y left, z up.
struct Head {
  /// Half its length, width and height [m].
  static constexpr double semi_axes[3] = {0.095, 0.075, 0.115};

  /// Most hairs that find a place at 200 per cm²: 650 cm² of scalp, the paper's "up to 130 000".
  static constexpr unsigned max_hairs = 130'000;

  /// The image of the point when the head becomes the unit sphere.
  static Eigen::Vector3d to_sphere(const Eigen::Vector3d& point) {
    return {point.x() / semi_axes[0], point.y() / semi_axes[1], point.z() / semi_axes[2]};
  }
  static Eigen::Vector3d from_sphere(const Eigen::Vector3d& point) {
    return {point.x() * semi_axes[0], point.y() * semi_axes[1], point.z() * semi_axes[2]};
  }

  /// Size of the concentric, similar ellipsoid through the point: 1 on the skin, less inside.
  static double level(const Eigen::Vector3d& point);

  /// The point itself, or moved away from the centre to this level if it lies below.
  static Eigen::Vector3d lifted(const Eigen::Vector3d& point, double min_level);

  /// Unit normal of the ellipsoid through the point, outwards.
  static Eigen::Vector3d normal(const Eigen::Vector3d& point);
};

/// Hairs per m² of scalp: the paper's 200 per cm².
constexpr double hair_density = 2e6;

/// Where a hair grows.
struct Root {
  Eigen::Vector3d point;   ///< [m]
  Eigen::Vector3d normal;  ///< unit, out of the skin
  Eigen::Vector2d map;     ///< place on a flat map of the scalp, about true to scale [m]
  double polar = 0.0;      ///< angle to the crown [turns]; 0 off the head
};

/// Roots on the Head, of hair_density on a patch around the crown that is as large as that takes.
/// They stand along a spiral, each somewhere in a cell of its own.
std::vector<Root> scalp_roots(std::uint32_t count, Random& random);

/// Roots on a disc z = 0 around the origin, whose normal points down: a tress is held there.
std::vector<Root> disc_roots(std::uint32_t count, Random& random);

/// Roots that share a square of the map.
struct Lock {
  std::uint32_t begin = 0;  ///< index of the first root
  std::uint32_t end = 0;    ///< one beyond the last
};

/// Puts the roots in the order in which a styling tool emits hairs: lock by lock, along a Hilbert
/// curve over the map, so that neighbours in the order are neighbours on the scalp at every scale.
/// @param lock_size [m] edge of a lock's square
std::vector<Lock> order_in_locks(std::vector<Root>& roots, double lock_size);

}  // namespace fiber
