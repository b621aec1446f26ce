#pragma once

#include <visualization_msgs/Marker.h>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber_proximity_ros {

/// A mesh of more triangles than this, of those near what is looked at, is drawn as its box: the
/// message would be of megabytes.
constexpr std::size_t most_mesh_triangles = 20'000;

/// Whether a shape reaches into a box [m], which must not be empty; bounded ones by their own
/// boxes.
bool reaches_into(const fiber::WorldBox& box, const fiber::Shape& shape,
                  const Eigen::Isometry3d& pose);

/// Sets type, pose, scale and points of a marker, which has no points yet, to those of a shape:
/// CUBE, SPHERE or CYLINDER; a TRIANGLE_LIST for cones, capsules and meshes; a CUBE_LIST of the
/// cells of an octree. A plane or half-space is a thin CUBE as wide as what is looked at. What has
/// no extent is drawn with `hairline_radius`, to be seen at all.
/// @param around of what is looked at [m], not empty: triangles of meshes and cells of octrees that
///               do not reach into it are left out
void draw_shape(const fiber::Shape& shape, const Eigen::Isometry3d& pose,
                const fiber::WorldBox& around, visualization_msgs::Marker& marker);

}  // namespace fiber_proximity_ros
