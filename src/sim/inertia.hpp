// Inertias of rods: their kinetic energy, and what impulses change. The two nodes of a rigid part
// are coupled (Rods::mass_couplings).
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Adds the kinetic energy of a rod [J].
void add_kinetic_energy(const Rods& rods, std::uint32_t rod, double& energy);

/// The mass that a node sets against an impulse on it alone [kg]: its own, or where it is that of a
/// rigid part, whose other end is free to move, less. A node of a joint is as if it were not
/// coupled: an impulse there acts on the joint.
double mass_against_impulse(const Rods& rods, std::uint32_t node);

/// How the velocities of an edge's two nodes change by a unit impulse on the other one [1/kg]; 0
/// where they are not coupled.
double coupled_mobility(const Rods& rods, std::uint32_t edge);

/// The other end of a node's rigid part, whose velocity an impulse on the node changes, too.
std::optional<std::uint32_t> coupled_node(const Rods& rods, std::uint32_t node);

/// Changes a node's velocity by an impulse on it alone, and so that of the other end of its rigid
/// part.
/// @param change [m/s] of the node
void change_velocity(Rods& rods, std::uint32_t node, const Eigen::Vector3d& change);

}  // namespace fiber
