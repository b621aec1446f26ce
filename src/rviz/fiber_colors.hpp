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

/// @param opacity from 0 to 1, as the others
Color to_color(const fiber_proximity_ros::Rgb& rgb, float opacity);

/// From blue at 0 over teal and amber to red at 1; what lies beyond has the colour of that end.
fiber_proximity_ros::Rgb ramp(double value);

/// Values that the ends of the ramp stand for; either may be the larger one.
struct ValueRange {
  double at_blue = 0.0;
  double at_red = 1.0;
};

/// Colours of points, by what is to be seen. All of them overwrite `colors`, one per point.
///
/// One colour, a little darker or brighter from fibre to fibre so that they can be told apart.
void color_alike(const fiber::FiberAssembly& fibers, const Color& color,
                 std::vector<Color>& colors);

/// Each fibre its own, of a palette.
void color_by_fiber(const fiber::FiberAssembly& fibers, float opacity, std::vector<Color>& colors);

/// A value per point, on the ramp; points without one are `otherwise`.
void color_by_value(const std::vector<std::optional<double>>& values, const ValueRange& range,
                    const Color& otherwise, std::vector<Color>& colors);

/// Radius of the segment that starts at a point, or for the last one of a fibre ends there [m].
std::vector<std::optional<double>> radii_of_points(const fiber::FiberAssembly& fibers);

/// Least distance of the contacts, the closest pair among them, that name a segment of the point
/// [m].
/// @throws std::invalid_argument if one names a segment that is not there or has no finite distance
std::vector<std::optional<double>> distances_of_points(
    const fiber::FiberAssembly& fibers, const fiber_proximity::ContactArray& contacts);

/// From the least to the greatest of the values; from 0 to 1 if there are none.
ValueRange range_of(const std::vector<std::optional<double>>& values);

}  // namespace fiber_proximity_rviz
