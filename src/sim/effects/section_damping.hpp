#pragma once

#include <vector>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

// Damping of rods with twist, whose cross-sections have directions of their own.

/// It keeps so many numbers of each edge and the node that the edge begins with: the length, and of
/// inner nodes both components of the turn, the twist, and the part of that which the directors
/// have.
constexpr std::size_t section_strains_per_node = 5;

/// Adds the strains that inner nodes have in a state, times a weight.
/// @param rods    their directors and tangents are those with which the step began
/// @param strains section_strains_per_node of each node
void add_section_strains(const Rods& rods, const RodState& state, double weight,
                         std::vector<double>& strains);

/// As Effect::energy() and Effect::add_derivatives().
/// @param earlier strains from which changes are measured
/// @param share   of each stiffness, against changes
void section_damping_energy(const RodPack& rods, const NodeValues& earlier, const double* share,
                            SimdBatch& energy);
void add_section_damping(const RodPack& rods, const NodeValues& earlier, const double* share,
                         PackSystem& system);

/// The moments of the pack's rods, by node: the three coordinates of that of bending, and that of
/// twisting [N m].
std::vector<SimdBatch> section_damping_moments(const RodPack& rods, const NodeValues& earlier,
                                               double share);

}  // namespace fiber
