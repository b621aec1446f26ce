#pragma once

#include <cstdint>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/scenes/options.hpp"

namespace fiber {

/// The paper's cloth (Fig. 1) as a plain weave: at scale 1, 250 warp yarns along y, then 250 weft
/// yarns along x, each 26 cm in 2 600 segments of a hair's radius, over a square of 25 cm. Yarns
/// are 1 mm apart and cross alternately over and under each other, pressed together there by a
/// tenth of their diameter. A smaller scale has fewer yarns on the same square: it thins the cloth.
/// At scale 1 there are 0.19 contacts per segment (margin 0): all four pairs at every crossing.
///
/// The cloth lies in soft folds of 1 cm; over the frames a wave of 4 mm runs through it once in 100
/// frames. Nothing is random: the seed has no effect. The same bits everywhere.
FiberAssembly cloth(const SceneOptions& options, std::uint32_t frame);

}  // namespace fiber
