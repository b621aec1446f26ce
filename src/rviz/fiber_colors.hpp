#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/ContactArray.h"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/ros/outputs/palette.hpp"

namespace fiber_proximity_rviz {

/// Red, green, blue and opacity, from 0 to 255.
using Color = std::array<std::uint8_t, 4>;

/// @param rgb     red, green and blue, each from 0 to 1
/// @param opacity from 0 to 1
Color to_color(const fiber_proximity_ros::Rgb& rgb, float opacity);

/// The colour map, from blue at 0 over teal and amber to red at 1; values beyond have the colour of
/// the nearer end.
fiber_proximity_ros::Rgb color_map(double value);

/// The values that the colour map's ends stand for; either may be the larger one.
struct ValueRange {
  double at_blue = 0.0;
  double at_red = 1.0;
};

/// Gives all points one colour, a little darker or brighter from fibre to fibre so that they can be
/// told apart.
/// @param colors overwritten, one per point
void color_flat(const fiber::FiberAssembly& fibers, const Color& color, std::vector<Color>& colors);

/// Gives each fibre a colour of its own, from a palette.
/// @param colors overwritten, one per point
void color_by_fiber(const fiber::FiberAssembly& fibers, float opacity, std::vector<Color>& colors);

/// Each point by its value, through the colour map; points without a value are `otherwise`.
void color_by_value(const std::vector<std::optional<double>>& values, const ValueRange& range,
                    const Color& otherwise, std::vector<Color>& colors);

/// The radius [m] of the segment that starts at each point; at the last point of a fibre, of the
/// segment that ends there.
std::vector<std::optional<double>> radii_of_points(const fiber::FiberAssembly& fibers);

/// Least distance of the contacts, the closest pair among them, that name a segment of the point
/// [m].
/// @throws std::invalid_argument if one names a segment that is not there or has no finite distance
std::vector<std::optional<double>> distances_of_points(
    const fiber::FiberAssembly& fibers, const fiber_proximity::ContactArray& contacts);

/// The range from the smallest to the largest of the values; from 0 to 1 if there are none.
ValueRange range_of(const std::vector<std::optional<double>>& values);

}  // namespace fiber_proximity_rviz
