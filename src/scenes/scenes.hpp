#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

/// The demo: five cables of 4 to 10 mm radius in about a metre over the ground z = 0. A trunk spans
/// the scene, a thin one winds around it, another is draped across it, one meanders on the ground
/// and one lies there in a loop. All sway; contacts come and go, with the loop's own among them.
///
/// A closed form of time without anything random, repeating every `cables_period` seconds.
/// @param time [s]
FiberAssembly cables(double time);

constexpr double cables_period = 12.0;  ///< [s]

/// The demo by frame, at 30 frames per second. A smaller scale leaves out the last cables.
/// @throws std::invalid_argument for a scale above 1: the scene is arranged by hand
FiberAssembly cables(const SceneOptions& options, std::uint32_t frame);

/// The paper's cloth (Fig. 1) as a plain weave: at scale 1, 250 warp yarns along y, then 250 weft
/// yarns along x, each 26 cm in 2 600 segments of a hair's radius, over a square of 25 cm. Yarns
/// are 1 mm apart and cross alternately over and under each other, pressed together there by a
/// tenth of their diameter. A smaller scale has fewer yarns on the same square: it thins the cloth.
/// At scale 1 there are 0.19 contacts per segment (margin 0): all four pairs at every crossing.
///
/// The cloth lies in soft folds of 1 cm; over the frames a wave of 4 mm runs through it once in 100
/// frames. Nothing is random: the seed has no effect. The same bits everywhere.
FiberAssembly cloth(const SceneOptions& options, std::uint32_t frame);

/// The paper's filament soup (Fig. 1): at scale 1, 10 000 random fibres of 100 segments in the unit
/// cube, of a hair's radius. The paper does not say how they were generated; here each is a random
/// walk of 1 m that bends gently and is reflected at the faces of the cube.
///
/// At scale 1, seed 1 and frame 0 there are 0.006 contacts per segment (margin 0).
///
/// Frames show the fibres swaying: a wave of 5 mm runs along each of them once in 100 frames. Every
/// frame is computed from nothing but the options and its number, and is the same bits everywhere.
FiberAssembly soup(const SceneOptions& options, std::uint32_t frame);

// Functions that make scenes.

/// Number of fibres of a scene that has `full_count` at scale 1.
/// @param points_per_fiber for the limit: an assembly holds fewer than 2³¹ points
/// @param max_fibers that the scene has room for
/// @throws std::invalid_argument naming the scale and what is allowed
std::uint32_t scaled_fiber_count(
    const SceneOptions& options, std::uint32_t full_count, std::uint32_t points_per_fiber,
    std::uint32_t max_fibers = std::numeric_limits<std::uint32_t>::max());

/// Fibres of so many points each, all of one radius [m].
FiberAssembly equal_fibers(std::vector<Eigen::Vector3d> points, std::uint32_t points_per_fiber,
                           double radius);

/// A random order of 0 … count − 1, the same on every machine.
std::vector<std::uint32_t> random_order(std::uint32_t count, std::uint64_t seed);

}  // namespace fiber
