#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "src/text/with_context.hpp"

namespace fiber {

// The parts of an obstacle, as files and messages give it. Sizes are validated later, with the
// object.

/// Names that obstacles may not have, as the node itself uses them.
inline const std::string cloud_name = "cloud";
inline const std::string robot_prefix = "robot/";  ///< followed by the name of a link

/// @throws std::invalid_argument for an empty name, or one of those above
void validate_obstacle_name(const std::string& name);

/// Pose of an obstacle or a shape. A quaternion a little off unit length is normalised: its squared
/// length may be wrong by 0.01, as tf2 has it (tf2/src/buffer_core.cpp). A pose that is zero
/// throughout, as messages are that nobody filled in, is the identity.
/// @param position [m]
/// @throws std::invalid_argument naming the value and what is allowed
Eigen::Isometry3d make_pose(const Eigen::Vector3d& position, const Eigen::Quaterniond& orientation);

enum class Primitive { BOX, SPHERE, CYLINDER, CONE };

/// @param dimensions [m] x, y and z of a box; the radius of a sphere; height and radius of others
/// @throws std::invalid_argument for a wrong number of them
Shape make_primitive(Primitive type, const std::vector<double>& dimensions);

/// The plane ax + by + cz + d = 0, and the half-space where that is at most 0.
/// @throws std::invalid_argument for coefficients that are not finite, or of no direction
PlaneShape make_plane(const Eigen::Vector4d& coefficients);
HalfSpaceShape make_half_space(const Eigen::Vector4d& coefficients);

/// Appends the shapes of one list, with their poses: one for each, or none where all are
/// identities.
/// @param kind    of shape, for errors
/// @param to_shape, to_pose make a shape of an item, and an Eigen::Isometry3d of a pose
/// @throws std::invalid_argument for another number of poses; naming the shape, for what these
/// throw
template <class Items, class Poses, class ToShape, class ToPose>
void append_shapes(const std::string& kind, const Items& items, const Poses& poses,
                   const ToShape& to_shape, const ToPose& to_pose,
                   std::vector<PlacedShape>& shapes) {
  if (!poses.empty() && poses.size() != items.size()) {
    throw std::invalid_argument(std::to_string(poses.size()) + " pose(s) of " +
                                std::to_string(items.size()) + " " + kind +
                                "(s); give one for each or none");
  }
  for (std::size_t i = 0; i < items.size(); ++i) {
    shapes.push_back(with_context(kind + " " + std::to_string(i), [&] {
      PlacedShape placed;
      placed.shape = to_shape(items[i]);
      if (!poses.empty()) {
        placed.pose = to_pose(poses[i]);
      }
      return placed;
    }));
  }
}

}  // namespace fiber
