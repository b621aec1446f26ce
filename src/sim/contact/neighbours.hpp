#pragma once

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Edges of one rod whose indices differ by at most this do not touch but by folding.
constexpr std::uint32_t contact_neighbour_skip = 2;

/// Nor do those with less of the rod between them than this [m], measured at rest: four radii.
inline double contact_neighbour_length(const Rods& rods, std::uint32_t rod) {
  return 4.0 * rods.radii[rod];
}

/// Whether two edges of one rod are too near each other along it to touch.
/// @param arcs arc length at rest from the rod's first node, by node [m]
inline bool are_contact_neighbours(const Rods& rods, const std::vector<double>& arcs,
                                   std::uint32_t rod, std::uint32_t edge_a, std::uint32_t edge_b) {
  const std::uint32_t first = edge_a < edge_b ? edge_a : edge_b;
  const std::uint32_t last = edge_a < edge_b ? edge_b : edge_a;
  return last - first <= contact_neighbour_skip ||
         arcs[last] - arcs[first + 1] < contact_neighbour_length(rods, rod);
}

/// Those arc lengths of all rods.
inline std::vector<double> contact_arcs(const Rods& rods) {
  std::vector<double> arcs(rods.positions.size(), 0.0);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      arcs[i + 1] = arcs[i] + rods.rest_lengths[i];
    }
  }
  return arcs;
}

/// Force by distance where surfaces meet that a rod's material makes natural [N/m]: a contact holds
/// a thousandth of what would stretch the rod to double its length when it is pressed from where
/// its barrier begins to where surfaces meet.
/// @param touching distance at which surfaces meet [m]
double material_contact_stiffness(const RodSection& section, double touching);

/// @param effect named by the error
/// @throws std::invalid_argument for a stiffness [N/m] that is negative or not finite
void validate_contact_stiffness(const std::string& effect, double stiffness);

}  // namespace fiber
