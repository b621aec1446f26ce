#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "fiber_proximity/geometry/contact_time.hpp"

namespace fiber {

/// Where a body is: a point x of it is at position + rotation · x.
struct Pose {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
};

/// A segment of a body that turns from one pose to the next: its position moves linearly, and it
/// turns at a constant rate about one axis, the shorter way round, as tf interpolates. A body that
/// does not turn moves as SegmentMotions do.
struct RigidSegment {
  Eigen::Vector3d ends[2];  ///< [m] in the body's frame
  Pose before;
  Pose after;
};

/// contact_time() of two segments of bodies that turn.
///
/// Points that turn leave the straight line between two places by at most ρ·θ²/8, ρ their distance
/// from the axis and θ the angle. The motion is halved, the earlier half first, until that is a
/// small part of the tolerance, or until straight motion with so much added to the limit rules
/// contact out.
/// @param limit     as of SegmentMotions
/// @param tolerance [m] positive: at 0 an answer would take halving for ever
/// @throws std::invalid_argument for a tolerance that is not positive and finite, or a rotation
/// that
///         is not of unit length
ContactTime contact_time(const RigidSegment& a, const RigidSegment& b, const ContactLimit& limit,
                         double tolerance);

}  // namespace fiber
