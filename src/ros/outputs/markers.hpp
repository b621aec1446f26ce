#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/crossings.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/ros/outputs/environment_markers.hpp"
#include "src/ros/outputs/marker_canvas.hpp"

namespace fiber_proximity_ros {

/// Options for drawing an answer.
struct MarkerOptions {
  bool show_fibers = true;
  bool show_contacts = true;
  bool show_nearest = true;
  bool show_cost = false;
  bool show_boxes = false;
  bool show_crossings = false;
  std::uint32_t level = 4;  ///< of the hierarchy, whose boxes the caller hands in; 0 is the root
  bool show_names = false;
  bool show_legend = false;
  bool show_passed = false;  ///< contacts that came and went, if there are any to show
  bool show_objects = true;
  double reach = 0.3;  ///< [m] objects whose boxes are further from all fibres are left out
  /// [m] Contacts whose true distance may be larger are possible only, and paler.
  double certain_margin = std::numeric_limits<double>::infinity();
  double free_distance = 0.1;  ///< [m] from here on the distance of an object is green; above 0
};

/// Crossings to draw, and how they are looked at. Holds references: only for the call.
struct CrossingDrawing {
  const std::vector<fiber::Crossing>& crossings;
  const fiber::View& view;
};

/// An answer to draw. Holds references: only for the call.
struct Drawing {
  const fiber::FiberAssembly& fibers;
  const std::vector<fiber::Contact>& contacts;
  const fiber::Contact* minimum;                    ///< the closest pair, nullptr if there is none
  const std::vector<fiber::NodeBox>& boxes;         ///< of the level to show, if boxes are shown
  const std::string& cost;                          ///< see answer_text(), if it is shown
  const CrossingDrawing* crossings = nullptr;       ///< nullptr if there are none to show
  const std::vector<std::string>* names = nullptr;  ///< of the fibres, if they are shown
  const std::vector<LegendLine>* legend = nullptr;  ///< if it is shown
  const std::vector<fiber::Contact>* passed = nullptr;  ///< contacts that came and went
  const std::vector<std::string>* unknown = nullptr;  ///< what the answer lacks; it is always shown
  const EnvironmentDrawing* environment = nullptr;    ///< nullptr if the fibres are alone
};

/// The legend of the markers that these options show: a line for each colour.
/// @param has_distances whether there are distances from objects to explain
/// @param margin        [m] of the contacts; may be infinite
std::vector<LegendLine> legend_lines(const MarkerOptions& options, bool has_distances,
                                     double margin);

/// Draws each crossing as diagrams of knots do, into a LINE_LIST marker: a bar along the strand
/// above, and of the strand below two stubs with a gap between them. In front of the fibres as the
/// view has it; green for the sign +1, magenta for −1.
/// @param thickness [m] of the lines
/// @param marker    gets its width, points and colours
void draw_crossings(const fiber::FiberAssembly& fibers, const CrossingDrawing& drawing,
                    double thickness, visualization_msgs::Marker& marker);

/// Draws fibres, contacts, boxes and what is around the fibres for rviz.
///
/// | ns             | id          | what                                                         |
/// |----------------|-------------|--------------------------------------------------------------|
/// | `fibers`       | fibre index | tubes of the exact radius (TRIANGLE_LIST); above             |
/// |                |             | `max_tube_segments` in all one LINE_LIST of id 0            |
/// | `contacts`     | n           | SPHERE_LIST midway between the surfaces; red in penetration, |
/// |                |             | amber within the margin, paler where that is not certain;    |
/// |                |             | one of each size                                             |
/// | `normals`      | 0           | LINE_LIST from there along the normal a→b                    |
/// | `passed`       | 0           | SPHERE_LIST where contacts came and went, of late; cyan      |
/// | `nearest`      | 0           | LINE_LIST between the nearest points of the closest pair     |
/// | `nearest_text` | 0           | its distance in mm, beside it                                |
/// | `nearest_leader`| 0          | LINE_LIST from there to the text                             |
/// | `cost`         | 0           | TEXT_VIEW_FACING above all fibres: see answer_text()         |
/// | `boxes`        | 0           | LINE_LIST of the edges of the boxes                          |
/// | `crossings`    | 0           | LINE_LIST: bars over, stubs under; green +1, magenta −1      |
/// | `names`        | fibre index | TEXT_VIEW_FACING at each fibre's first point, unless there   |
/// |                |             | are more than `max_names`                                   |
/// | `legend`       | line        | TEXT_VIEW_FACING below all fibres and in front of them, one  |
/// |                |             | line below another                                           |
/// | `axes`         | 0           | LINE_LIST beside the fibres, with the legend: x red, y       |
/// |                |             | green, z blue, as the frame has them                         |
/// | `incomplete`   | 0           | TEXT_VIEW_FACING above all: what the answer lacks; red       |
/// | `obstacles`    | n           | half-transparent shapes near fibres, see draw_shape()        |
/// | `robot`        | n           | half-transparent shapes of the robot's links near fibres     |
/// | `environment_distances` | 0  | LINE_LIST between nearest points, coloured by distance       |
/// | `environment_points`    | 0  | SPHERE_LIST of the points on the objects, so coloured, too   |
/// | `environment_nearest`   | 0  | LINE_LIST between the nearest points of the closest pair     |
/// | `environment_nearest_text` | 0 | its object's name and distance in mm, beside it            |
/// | `environment_nearest_leader` | 0 | LINE_LIST from the object to the text                    |
///
/// Above is z, or −y in a camera's optical frame.
class MarkerBuilder {
 public:
  /// More segments than this would make messages of many megabytes: 1.2 kB each.
  static constexpr std::size_t max_tube_segments = 5000;

  /// More names than this cannot be read.
  static constexpr std::size_t max_names = 20;

  /// Markers of one update; ends with DELETE for what the previous call drew and this one does not.
  /// @param markers overwritten; memory of an earlier call is reused
  void build(const std_msgs::Header& header, const Drawing& drawing, const MarkerOptions& options,
             visualization_msgs::MarkerArray& markers);

 private:
  MarkerCanvas::Counts drawn_;  // what is on the screen
};

}  // namespace fiber_proximity_ros
