#pragma once

#include <cstdint>

namespace fiber {

/// What every scene takes.
struct SceneOptions {
  double scale = 1.0;      ///< of the number of fibres; above 0. At least one fibre remains.
  std::uint64_t seed = 1;  ///< of all that is random
};

/// Number of fibres of a scene that has `full_count` at scale 1.
/// @param points_per_fiber for the limit: an assembly holds fewer than 2³¹ points
/// @throws std::invalid_argument naming the scale and what is allowed
std::uint32_t scaled_fiber_count(const SceneOptions& options, std::uint32_t full_count,
                                 std::uint32_t points_per_fiber);

}  // namespace fiber
