#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "src/ros/outputs/marker_canvas.hpp"

namespace fiber_proximity_ros {

/// The objects around the fibres, to draw. Holds references: only for the call.
struct EnvironmentDrawing {
  const std::vector<fiber::EnvironmentObject>& objects;
  const std::vector<fiber::Contact>& contacts;  ///< fiber_b is the index of the object
  const fiber::Contact* minimum;                ///< the closest pair, nullptr if there is none
};

/// A mesh of more triangles than this, of those near what is looked at, is drawn as its box: the
/// message would be of megabytes.
constexpr std::size_t max_mesh_triangles = 20'000;

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

/// Red at contact and in penetration, over yellow, to green from `free_distance` [m] on.
std_msgs::ColorRGBA distance_color(double distance, double free_distance);

/// Draws the shapes near the fibres, of which there must be any, half-transparent.
/// @param reach [m] objects whose boxes are further from all fibres are left out
void draw_objects(const fiber::FiberAssembly& fibers,
                  const std::vector<fiber::EnvironmentObject>& objects, double reach,
                  MarkerCanvas& canvas);

/// Draws lines between nearest points, and the points on the objects, coloured by distance.
/// @param thickness [m] of what is drawn
void draw_distances(const std::vector<fiber::Contact>& contacts, double free_distance,
                    double thickness, MarkerCanvas& canvas);

/// Draws the closest pair, of which there must be one, with its object's name and its distance.
void draw_nearest_object(const fiber::FiberAssembly& fibers, const EnvironmentDrawing& drawing,
                         double free_distance, const MarkerScale& scale, MarkerCanvas& canvas);

}  // namespace fiber_proximity_ros
