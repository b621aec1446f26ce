#pragma once

#include <string>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// Sees to it that no fibre begins inside of itself, of another or of an obstacle, as far as the
/// scene names the effects that are contacts of these.
/// @param attachment that holds nodes which do not move; null for none
/// @param rods       are moved apart if the scene says so (separate_overlaps())
/// @returns what was moved, for the log; empty if nothing was
/// @throws std::invalid_argument naming file and line of both fibres, their names, segments and how
///         deep they are in each other
std::string settle_overlaps(const SimDescription& scene, const Attachment* attachment, Rods& rods);

}  // namespace fiber
