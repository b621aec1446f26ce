#pragma once

#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "src/sim/contact/obstacle_contact.hpp"

namespace fiber {

/// Adds the contacts that a node or an edge may have with a shape near it: with each of its pieces
/// that is within a distance.
/// @param shape  must outlive what is found
/// @param edge   as Rods counts edges
/// @param part   a node, or all of the edge
/// @param within [m]
void add_obstacle_contacts(const ObstacleShape& shape, const Rods& rods, std::uint32_t rod,
                           std::uint32_t edge, const EdgePart& part,
                           const EnvironmentContact::Options& options, double within,
                           std::vector<ObstacleContact>& found);

}  // namespace fiber
