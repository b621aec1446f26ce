#pragma once

#include <array>
#include <vector>

#include "src/sim/joint/joint_parts.hpp"

namespace fiber {

/// How a weld goes along its first edge.
enum class WeldPath {
  AS_GIVEN,
  SHORTER  ///< the other way round, if it turned by more than a right angle otherwise
};

/// Makes a weld between two edges as they are now, with no twist. It has no stiffness yet.
/// @param edges the first gone along towards their place, the second away from it
Weld make_weld(const Rods& rods, const std::array<WeldedEdge, 2>& edges, WeldPath path);

/// The edges that end at a place, each gone along away from it.
std::vector<WeldedEdge> edges_at(const Rods& rods, const std::vector<PlacedNode>& place);

/// Adds the welds between all edges that meet at a place, but for those of one rod that follow each
/// other: springs from each to a common point, which is left out.
void add_welds(const Rods& rods, const std::vector<PlacedNode>& place, std::vector<Weld>& welds);

/// The weld that makes the seam of a closed rod bend and twist as its inner nodes do.
/// @param has_bend whether it resists bending
Weld make_seam(const Rods& rods, std::uint32_t rod, bool has_bend);

}  // namespace fiber
