#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/world.hpp"
#include "src/ros/environment/robot_description.hpp"
#include "src/ros/inputs/fixed_frame.hpp"

namespace fiber_proximity_ros {

/// The links of a robot where tf has them. One that tf does not know, or has not heard of for
/// long, is left out of the world and unknown; the rest goes on.
class RobotLinks {
 public:
  /// Pose of a frame at a time, or the latest there is; throws TransformUnavailable.
  using FindPose = std::function<FramePose(const std::string& frame, const ros::Time& stamp)>;

  /// @param timeout [s] a transform that is older than this is none
  RobotLinks(const std::vector<RobotLink>& links, double timeout);

  /// Brings the links to where they are at this time.
  /// @returns true if the world changed
  bool update(const ros::Time& stamp, const FindPose& find_pose, fiber::World& world);

  /// Names of the links that are not in the world, and why.
  std::vector<std::string> unknown() const;

 private:
  struct Link {
    std::string frame;
    fiber::EnvironmentObject object;  // where it was last
    bool is_present = false;
    std::string error;
  };

  /// None where it is unknown; the link's error says why then.
  std::optional<Eigen::Isometry3d> find_pose(Link& link, const ros::Time& stamp,
                                             const FindPose& find_pose) const;

  /// What brings the link there, or away; none where it stays.
  static std::optional<fiber::ObjectChange> place(Link& link,
                                                  const std::optional<Eigen::Isometry3d>& pose);

  std::vector<Link> links_;
  double timeout_;
};

}  // namespace fiber_proximity_ros
