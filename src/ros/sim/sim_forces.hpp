#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/ForceArray.h"
#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/ros/outputs/marker_canvas.hpp"

namespace fiber_proximity_ros {

/// Publishes the forces in fibres and on them while anybody listens:
///
/// - ~forces: all of it
/// - ~wrenches/FIBRE/NODE: for each hold what the fibre exerts on it, as a sensor of force and
///   torque in a gripper measures it. For a hold that follows a frame of tf it is in that frame and
///   about its origin; for other holds in the scene's frame and about the node.
/// - ~obstacle_wrenches/NAME: what fibres exert on an obstacle that moves, in the scene's frame and
///   about the obstacle's origin
/// - ~force_markers: drawn for rviz
///
/// | ns       | what                                                                            |
/// |----------|---------------------------------------------------------------------------------|
/// | tensions | each edge's: from blue, pressure, over white, none, to red, tension             |
/// | contacts | arrows of contact forces with friction, on the fibre that comes first           |
/// | holds    | arrows of what holds exert on fibres                                            |
/// | legend   | what is how much: it changes by steps, as forces grow and fall                  |
class SimForces {
 public:
  explicit SimForces(const ros::NodeHandle& node);

  /// Begins with another scene, whose fibres may have other names.
  void begin() {
    wrenches_.clear();
    obstacle_wrenches_.clear();
    obstacle_names_.clear();
  }

  /// @param header of the frame
  void publish(const fiber::SimScene& scene, const std_msgs::Header& header);

 private:
  using Hold = std::pair<std::uint32_t, std::uint32_t>;  // rod and node

  bool has_listeners() const;
  void advertise_obstacles(const fiber::SimScene& scene);
  ros::Publisher& wrench_topic(const fiber::SimScene& scene, const Hold& hold);
  void draw(const fiber::SimScene& scene, const fiber::RodForces& forces,
            const std_msgs::Header& header);

  ros::NodeHandle node_;
  ros::Publisher forces_;
  ros::Publisher drawing_;
  std::map<Hold, ros::Publisher> wrenches_;
  std::vector<ros::Publisher> obstacle_wrenches_;  // by obstacle that moves
  std::vector<std::string> obstacle_names_;        // of these
  fiber_proximity::ForceArray message_;
  visualization_msgs::MarkerArray markers_;
  MarkerCanvas::Counts drawn_;
  // Scales of what is drawn, which fall by little and little [N].
  double max_tension_ = 0.0;
  double max_force_ = 0.0;
};

}  // namespace fiber_proximity_ros
