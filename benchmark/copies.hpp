#pragma once

#include <cstdint>

#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

/// Copies of a scene side by side on a cubic grid, as far apart as it is large in frame 0: a scene
/// that grows while its density, and what each of its fibres touches, stay.
/// @param copies at least 1
/// @throws std::invalid_argument if there are 2³¹ points or more
Scene side_by_side(Scene scene, std::uint32_t copies);

}  // namespace fiber
