#pragma once

#include <cstdint>
#include <memory>

#include "fiber_proximity/environment/triangle_mesh.hpp"

namespace fiber {

/// A capsule along z as a closed mesh, as robots' links come: triangles of about the same height.
/// @param radius    [m]
/// @param length    [m] between the centres of its caps; 0 for a sphere
/// @param triangles twice a square number; others are rounded down to one, and up to 18
std::shared_ptr<const TriangleMesh> capsule_mesh(double radius, double length,
                                                 std::uint32_t triangles);

}  // namespace fiber
