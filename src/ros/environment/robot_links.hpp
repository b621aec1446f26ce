#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/environment/world.hpp"
#include "src/ros/environment/mesh_loader.hpp"
#include "src/ros/environment/object_tracks.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/support/unknown.hpp"

namespace fiber_proximity_ros {

/// A link of a robot that has collision geometry.
struct RobotLink {
  std::string frame;                ///< of tf
  fiber::EnvironmentObject object;  ///< named robot/LINK, in the link's frame
};

/// The links of a robot with collision geometry, in the order of their names; what is only to be
/// seen is not read.
/// @param description URDF
/// @throws std::invalid_argument for what is no URDF, and naming the link whose geometry is bad
std::vector<RobotLink> read_robot(const std::string& description, const MeshLoader& meshes);

/// The URDF that a parameter has.
/// @throws std::invalid_argument naming the parameter, if it is not set or no name
std::string robot_description(const ros::NodeHandle& node, const std::string& parameter);

/// Gives the shapes of links whose robots are described by parameters, by default that with the
/// name robot_description.
/// @param node in whose namespace parameters are
fiber::LinkSource robot_links(const ros::NodeHandle& node, const MeshLoader& meshes);

/// The links of a robot where tf has them. One that tf does not know, or has not heard of for
/// long, is left out of the world and unknown; the rest goes on.
class RobotLinks {
 public:
  /// Pose of a frame at a time, or the latest there is; throws TransformUnavailable.
  using FindPose = std::function<FramePose(const std::string& frame, const ros::Time& stamp)>;

  /// @param timeout [s] a transform that is older than this is none
  RobotLinks(const std::vector<RobotLink>& links, double timeout);

  /// Brings the links to where they are at this time.
  /// @param tracks of those that are in the world, by what tf tells
  /// @returns true if the world changed
  bool update(const ros::Time& stamp, const FindPose& find_pose, fiber::World& world,
              ObjectTracks& tracks);

  /// The links that are not in the world.
  std::vector<Unknown> unknown() const;

 private:
  /// Where it was last.
  struct Link : RobotLink {
    explicit Link(const RobotLink& link) : RobotLink(link) {}

    bool is_present = false;
    ros::Time known;  // when it was last, or was first looked for
    std::string error = "not looked for yet";
  };

  /// None where it is unknown; the link's error says why then.
  std::optional<FramePose> find_pose(Link& link, const ros::Time& stamp,
                                     const FindPose& find_pose) const;

  /// The change that brings the link there, or away; none where it stays.
  static std::optional<fiber::ObjectChange> place(Link& link,
                                                  const std::optional<FramePose>& found);

  std::vector<Link> links_;
  double timeout_;
};

}  // namespace fiber_proximity_ros
