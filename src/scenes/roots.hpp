#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "src/scenes/random.hpp"

namespace fiber {

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

/// The same on a disc z = 0 around the origin, whose normal points down: a tress is held there.
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
