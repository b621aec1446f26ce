#pragma once

#include <cstdint>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/scenes/options.hpp"

namespace fiber {

/// The paper's filament soup (Fig. 1): at scale 1, 10 000 random fibres of 100 segments in the unit
/// cube, of a hair's radius. The paper does not say how they were generated; here each is a random
/// walk of 1 m that bends gently and is reflected at the faces of the cube.
///
/// At scale 1, seed 1 and frame 0 there are 0.006 contacts per segment (margin 0).
///
/// Frames show the fibres swaying: a wave of 5 mm runs along each of them once in 100 frames. Every
/// frame is computed from nothing but the options and its number, and is the same bits everywhere.
FiberAssembly soup(const SceneOptions& options, std::uint32_t frame);

}  // namespace fiber
