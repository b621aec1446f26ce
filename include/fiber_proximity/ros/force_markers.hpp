#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include "fiber_proximity/ros/marker_canvas.hpp"
#include "fiber_proximity/ros/marker_scale.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber_proximity_ros {

/// Draws what acts in fibres and on them for rviz.
///
/// | ns       | what                                                                            |
/// |----------|---------------------------------------------------------------------------------|
/// | tensions | each edge's: from blue, pressure, over white, none, to red, tension             |
/// | contacts | arrows of contact forces with friction, on the fibre that comes first           |
/// | holds    | arrows of what holds exert on fibres                                            |
/// | legend   | what is how much: it changes by steps, as forces grow and fall                  |
class ForceMarkers {
 public:
  /// @param markers overwritten; memory is reused
  void draw(const fiber::SimScene& scene, const fiber::RodForces& forces,
            const std_msgs::Header& header, visualization_msgs::MarkerArray& markers);

 private:
  using Canvas = MarkerCanvas<4>;

  void draw_tensions(const fiber::Rods& rods, const fiber::RodForces& forces, Canvas& canvas) const;
  void draw_arrows(const fiber::RodForces& forces, const MarkerScale& scale, Canvas& canvas) const;
  void draw_legend(const MarkerScale& scale, Canvas& canvas) const;

  double most_tension_ = 0.0;  // [N] what full red is
  double most_force_ = 0.0;    // [N] of the longest arrow
  Canvas::Counts drawn_{};
};

}  // namespace fiber_proximity_ros
