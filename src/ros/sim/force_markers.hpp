#pragma once

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/ros/outputs/marker_canvas.hpp"

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
  using Canvas = MarkerCanvas<4>;

  /// @param markers overwritten; memory is reused
  void draw(const fiber::SimScene& scene, const fiber::RodForces& forces,
            const std_msgs::Header& header, visualization_msgs::MarkerArray& markers);

 private:
  // Scales, which fall by little and little [N].
  double most_tension_ = 0.0;
  double most_force_ = 0.0;
  Canvas::Counts drawn_{};
};

}  // namespace fiber_proximity_ros
