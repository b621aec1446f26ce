#pragma once

#include <cstdint>

#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

// The scenes of make_large_scene(). Their function `fibers` takes numbers of fibres unseen.

LargeScene large_soup(std::uint64_t segments, std::uint64_t seed);

LargeScene many_tresses(std::uint64_t segments, std::uint64_t seed);

LargeScene many_locks(std::uint64_t segments, std::uint64_t seed);

}  // namespace fiber
