#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "src/ros/outputs/marker_canvas.hpp"
#include "src/ros/outputs/marker_scale.hpp"

namespace fiber_proximity_ros {

/// What to draw of the environment.
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

/// Red at contact and in penetration, over yellow, to green from `free_distance` [m] on.
std_msgs::ColorRGBA distance_color(double distance, double free_distance);

/// Draws what is around the fibres for rviz.
///
/// | ns                         | id | what                                                       |
/// |----------------------------|----|------------------------------------------------------------|
/// | `obstacles`                | n  | half-transparent shapes near fibres, see draw_shape()      |
/// | `robot`                    | n  | the same of the robot's links                              |
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
  enum Namespace : std::uint8_t { OBSTACLES, ROBOT, DISTANCES, POINTS, NEAREST, TEXT, COUNT };
  using Canvas = MarkerCanvas<COUNT>;

  static void draw_objects(const EnvironmentDrawing& drawing, double reach, Canvas& canvas);
  static void draw_distances(const std::vector<fiber::Contact>& contacts, double free_distance,
                             double thickness, Canvas& canvas);
  static void draw_nearest(const EnvironmentDrawing& drawing, double free_distance,
                           const MarkerScale& scale, Canvas& canvas);

  // By namespace: ids 0 .. count−1 are on the screen.
  Canvas::Counts drawn_{};
};

}  // namespace fiber_proximity_ros
