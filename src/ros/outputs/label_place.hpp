#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "src/ros/outputs/marker_canvas.hpp"

namespace fiber_proximity_ros {

/// A text that belongs to a point.
struct Label {
  Eigen::Vector3d point;      ///< [m] what it is about
  Eigen::Vector3d preferred;  ///< unit vector: where it lies if there is room
  double gap;                 ///< [m] from there to the text
  double height;              ///< [m] of its letters
  std::size_t letters;        ///< how many
  /// Unit vector into a body whose inside would hide the text; 0 if there is none.
  Eigen::Vector3d inwards = Eigen::Vector3d::Zero();
  std::vector<PlacedText> others = {};  ///< it lies across none of them, if that can be
};

/// [m] How wide a text is, about.
double text_width(double height, std::size_t letters);

/// Middle of the text: beside its point, where no fibre hides it. Directions are tried from the
/// preferred one and up, then three gaps away, to down, and the first with room wins, so that a
/// text stays where it is while fibres move elsewhere; where there is no room at all, the one with
/// most.
///
/// Whoever looks at fibres is taken to look from the front and a little from above: what lies
/// before or behind a text there hides it, however far away. Of more segments than
/// `max_label_segments` none is looked at: the preferred direction is taken.
Eigen::Vector3d label_place(const fiber::FiberAssembly& fibers, const MarkerScale& scale,
                            const Label& label);

/// The end of a line from the point to the text, a little before its letters.
/// @param place as label_place() has it
Eigen::Vector3d leader_end(const MarkerScale& scale, const Label& label,
                           const Eigen::Vector3d& place);

/// Draws the line between the points of a closest pair, the text that belongs to it, and a leader
/// from the label's point to the text. Their namespaces are `ns`, `ns`_text and `ns`_leader.
void draw_closest_pair(const fiber::FiberAssembly& fibers, const MarkerScale& scale,
                       const fiber::Contact& pair, const std_msgs::ColorRGBA& color,
                       const Label& label, const std::string& text, const std::string& ns,
                       MarkerCanvas& canvas);

/// Looking for room takes time for each of them.
constexpr std::size_t max_label_segments = 20'000;

}  // namespace fiber_proximity_ros
