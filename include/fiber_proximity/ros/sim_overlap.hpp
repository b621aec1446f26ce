#pragma once

#include <string>

#include "fiber_proximity/ros/sim_effects.hpp"

namespace fiber_proximity_ros {

/// Reads the key `initial_overlap` of a scene: `refuse`, if there is none, or `separate`; and sees
/// to it that no fibre begins inside of itself, of another or of an obstacle, as far as the scene
/// names the effects that are contacts of these.
/// @param rods    with separate, are moved apart (fiber::separate_overlaps)
/// @returns what was moved, for the log; empty if nothing was
/// @throws std::invalid_argument naming file and line of both fibres, their names, segments and how
///         deep they are in each other
std::string read_initial_overlap(const YamlField& document, const SimWorld& world,
                                 const SimEffects& effects, fiber::Rods& rods);

}  // namespace fiber_proximity_ros
