#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>

#include <map>
#include <string>
#include <utility>

#include "fiber_proximity/ForceArray.h"
#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/ros/sim/force_markers.hpp"

namespace fiber_proximity_ros {

/// Publishes what acts in fibres and on them, as far as anybody listens:
///
/// - ~forces: all of it
/// - ~wrenches/FIBRE/NODE: for each hold what the fibre exerts on it, as a sensor of force and
///   torque in a gripper measures it. Of what a frame of tf holds, in that frame and about its
///   origin; of other holds in the scene's frame and about the node.
/// - ~force_markers: drawn for rviz, see ForceMarkers
class SimForces {
 public:
  explicit SimForces(const ros::NodeHandle& node);

  /// Begins with another scene, whose fibres may have other names.
  void begin() { wrenches_.clear(); }

  /// @param header of the frame
  void publish(const fiber::SimScene& scene, const std_msgs::Header& header);

 private:
  using Hold = std::pair<std::uint32_t, std::uint32_t>;  // rod and node

  bool has_listeners() const;
  ros::Publisher& wrench_topic(const fiber::SimScene& scene, const Hold& hold);
  void advertise_wrenches(const fiber::SimScene& scene);

  ros::NodeHandle node_;
  ros::Publisher forces_;
  ros::Publisher drawing_;
  std::map<Hold, ros::Publisher> wrenches_;
  ForceMarkers markers_;
  fiber_proximity::ForceArray message_;
  visualization_msgs::MarkerArray drawn_;
};

/// Memory of the message is reused.
void to_message(const fiber::SimScene& scene, const fiber::RodForces& forces,
                fiber_proximity::ForceArray& message);

/// What the fibre exerts on a hold; see SimForces.
/// @param header of what is in the scene's frame
geometry_msgs::WrenchStamped wrench_of(const fiber::SimScene& scene,
                                       const fiber::RodForces::HoldForce& hold,
                                       const std_msgs::Header& header);

}  // namespace fiber_proximity_ros
