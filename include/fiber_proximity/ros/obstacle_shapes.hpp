#pragma once

#include <shape_msgs/Mesh.h>
#include <shape_msgs/Plane.h>
#include <shape_msgs/SolidPrimitive.h>

#include <cstddef>

#include "fiber_proximity/Capsule.h"
#include "fiber_proximity/environment/shapes.hpp"

namespace fiber_proximity_ros {

/// Shapes of messages as those of the library, which validates their sizes later.
/// @throws std::invalid_argument for an unknown type or a wrong number of dimensions
fiber::Shape to_shape(const shape_msgs::SolidPrimitive& primitive);
fiber::Shape to_shape(const fiber_proximity::Capsule& capsule);
/// @throws std::invalid_argument as fiber::TriangleMesh
fiber::Shape to_shape(const shape_msgs::Mesh& mesh);

/// Whether building meshes of so many triangles would keep the node from answering for longer than
/// a small query takes; then it is left to a Worker.
inline bool is_large_mesh(std::size_t triangles) {
  constexpr std::size_t most_at_once = 500;  // about 2 ms
  return triangles > most_at_once;
}

/// The plane ax + by + cz + d = 0, and the half-space where that is at most 0.
/// @throws std::invalid_argument for coefficients that are not finite, or of no direction
fiber::PlaneShape to_plane(const shape_msgs::Plane& plane);
fiber::HalfSpaceShape to_half_space(const shape_msgs::Plane& plane);

}  // namespace fiber_proximity_ros
