#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fiber {

/// The points of a depth camera that looks down on a table with clutter, and the floor around it: a
/// point for each pixel [m], off along its ray by noise that grows with the square of the depth.
/// @param count of pixels; the picture is about 4 by 3
std::vector<Eigen::Vector3d> camera_cloud(std::uint32_t count, std::uint64_t seed);

}  // namespace fiber
