#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "src/ros/outputs/marker_canvas.hpp"

namespace fiber_proximity_ros {

/// Options for drawing the environment.
struct EnvironmentMarkerOptions {
  bool show_objects = true;
  bool show_distances = true;
  bool show_nearest = true;
  double reach = 0.3;          ///< [m] objects whose boxes are further from all fibres are left out
  double free_distance = 0.1;  ///< [m] from here on a distance is green; above 0
};

/// An answer of fiber::Environment::query to draw. Holds references: only for the call.
struct EnvironmentDrawing {
  const fiber::FiberAssembly& fibers;
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

/// Draws what is around the fibres for rviz.
///
/// | ns                         | id | what                                                       |
/// |----------------------------|----|------------------------------------------------------------|
/// | `obstacles`                | n  | half-transparent shapes near fibres, see draw_shape()      |
/// | `robot`                    | n  | half-transparent shapes of the robot's links near fibres   |
/// | `environment_distances`    | 0  | LINE_LIST between nearest points, coloured by distance     |
/// | `environment_points`       | 0  | SPHERE_LIST of the points on the objects, so coloured, too |
/// | `environment_nearest`      | 0  | LINE_LIST between the nearest points of the closest pair   |
/// | `environment_nearest_text` | 0  | its object's name and distance in mm, above the fibres     |
class EnvironmentMarkers {
 public:
  /// Appends the markers of one update, then DELETE for what the previous call drew and this one
  /// does not.
  void append(const std_msgs::Header& header, const EnvironmentDrawing& drawing,
              const EnvironmentMarkerOptions& options, visualization_msgs::MarkerArray& markers);

 private:
  MarkerCanvas::Counts drawn_;  // what is on the screen
};

}  // namespace fiber_proximity_ros
