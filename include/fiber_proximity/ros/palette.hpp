#pragma once

#include <array>
#include <cstdint>

namespace fiber_proximity_ros {

/// Red, green and blue, each from 0 to 1.
using Rgb = std::array<float, 3>;

/// Colours that tell fibres apart: cool and pale ones, for red and amber belong to contacts.
inline const Rgb& fiber_color(std::uint32_t fiber) {
  static constexpr std::array<Rgb, 8> palette{{{0.16F, 0.50F, 0.86F},
                                               {0.10F, 0.68F, 0.60F},
                                               {0.56F, 0.43F, 0.86F},
                                               {0.78F, 0.82F, 0.86F},
                                               {0.42F, 0.70F, 0.30F},
                                               {0.32F, 0.74F, 0.90F},
                                               {0.82F, 0.50F, 0.74F},
                                               {0.34F, 0.42F, 0.58F}}};
  return palette[fiber % palette.size()];
}

}  // namespace fiber_proximity_ros
