#pragma once

#include <array>
#include <cstdint>

namespace fiber_proximity_ros {

/// Red, green and blue, each from 0 to 1.
using Rgb = std::array<float, 3>;

/// From a to b as a part from 0 to 1.
inline Rgb mix(const Rgb& a, const Rgb& b, double part) {
  const auto u = static_cast<float>(part);
  return {a[0] + u * (b[0] - a[0]), a[1] + u * (b[1] - a[1]), a[2] + u * (b[2] - a[2])};
}

/// Colours of distances, crossings and forces, the same in every picture.
namespace palette {
constexpr Rgb penetrating{0.95F, 0.15F, 0.12F};
constexpr Rgb within_margin{1.0F, 0.70F, 0.10F};
constexpr Rgb possible{1.0F, 0.95F, 0.9F};
constexpr Rgb normal{1.0F, 0.82F, 0.5F};
constexpr Rgb incomplete{1.0F, 0.25F, 0.2F};
constexpr Rgb passed{0.10F, 0.95F, 1.0F};
constexpr Rgb nearby{1.0F, 0.85F, 0.10F};
constexpr Rgb distant{0.25F, 0.80F, 0.35F};
constexpr Rgb nearest{1.0F, 1.0F, 1.0F};
constexpr Rgb boxes{0.75F, 0.85F, 1.0F};
constexpr Rgb positive_crossing{0.25F, 0.90F, 0.35F};
constexpr Rgb negative_crossing{0.90F, 0.25F, 0.85F};
constexpr Rgb pulled{0.95F, 0.20F, 0.12F};
constexpr Rgb unloaded{0.95F, 0.95F, 0.95F};
constexpr Rgb pressed{0.15F, 0.35F, 1.00F};
constexpr Rgb contact_force{1.0F, 0.85F, 0.10F};
constexpr Rgb hold_force{0.25F, 0.85F, 0.35F};
}  // namespace palette

/// Colours that tell fibres apart: cool and pale ones, for red and amber belong to contacts.
inline const Rgb& fiber_color(std::uint32_t fiber) {
  static constexpr std::array<Rgb, 8> colors{{{0.16F, 0.50F, 0.86F},
                                              {0.10F, 0.68F, 0.60F},
                                              {0.56F, 0.43F, 0.86F},
                                              {0.78F, 0.82F, 0.86F},
                                              {0.42F, 0.70F, 0.30F},
                                              {0.32F, 0.74F, 0.90F},
                                              {0.82F, 0.50F, 0.74F},
                                              {0.34F, 0.42F, 0.58F}}};
  return colors[fiber % colors.size()];
}

}  // namespace fiber_proximity_ros
