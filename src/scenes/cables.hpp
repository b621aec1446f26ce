#pragma once

#include <cstdint>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/scenes/options.hpp"

namespace fiber {

/// The demo: five cables of 4 to 10 mm radius in about a metre over the ground z = 0. A trunk spans
/// the scene, a thin one winds around it, another is draped across it, one meanders on the ground
/// and one lies there in a loop. All sway; contacts come and go, with the loop's own among them.
///
/// A closed form of time without anything random, repeating every `cables_period` seconds.
/// @param time [s]
FiberAssembly cables(double time);

constexpr double cables_period = 12.0;  ///< [s]

/// The same by frame, at 30 frames per second.
/// A smaller scale leaves out the last cables.
/// @throws std::invalid_argument for a scale above 1: the scene is arranged by hand
FiberAssembly cables(const SceneOptions& options, std::uint32_t frame);

}  // namespace fiber
