#pragma once

#include <cstdint>
#include <limits>

namespace fiber {

/// What every scene takes.
struct SceneOptions {
  double scale = 1.0;      ///< of the number of fibres; above 0. At least one fibre remains.
  std::uint64_t seed = 1;  ///< of all that is random
  bool shuffle = false;    ///< put the fibres into random order
};

/// Number of fibres of a scene that has `full_count` at scale 1.
/// @param points_per_fiber for the limit: an assembly holds fewer than 2³¹ points
/// @param most_fibers that the scene has room for
/// @throws std::invalid_argument naming the scale and what is allowed
std::uint32_t scaled_fiber_count(
    const SceneOptions& options, std::uint32_t full_count, std::uint32_t points_per_fiber,
    std::uint32_t most_fibers = std::numeric_limits<std::uint32_t>::max());

}  // namespace fiber
