#pragma once

#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

// Rods as fibres that have each node twice, one segment of no length between the two: segments of
// even index are nodes, the others edges.

inline std::vector<Eigen::Vector3d> doubled(const std::vector<Eigen::Vector3d>& points) {
  std::vector<Eigen::Vector3d> doubled;
  doubled.reserve(2 * points.size());
  for (const Eigen::Vector3d& point : points) {
    doubled.push_back(point);
    doubled.push_back(point);
  }
  return doubled;
}

/// Edges first to last, and the nodes at their ends, as segments of the doubled fibres.
inline AllowedPair doubled(const AllowedPair& pair) {
  AllowedPair doubled = pair;
  doubled.first_segment = 2 * pair.first_segment + (pair.first_segment < 0 ? -1 : 0);
  doubled.last_segment = 2 * pair.last_segment + (pair.last_segment < 0 ? 1 : 2);
  return doubled;
}

inline FiberAssembly doubled_fibers(const Rods& rods) {
  std::vector<std::uint32_t> offsets = rods.offsets;
  for (std::uint32_t& offset : offsets) {
    offset *= 2;
  }
  return FiberAssembly(doubled(rods.positions), offsets, rods.radii);
}

}  // namespace fiber
