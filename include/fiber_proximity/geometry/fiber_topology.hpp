#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Tells which points of many fibres are joined: by default none are, and every fibre is an open
/// chain of its own.
///
/// Joined points are neighbours along the graph: neighbour skips count along the shortest way, and
/// the rule of loops (LoopTest) asks every way.
struct FiberTopology {
  /// By fibre, not 0 where the last point is joined to the first by a segment of its own, which is
  /// the fibre's last one; the first point is not repeated. Empty: none is closed.
  std::vector<std::uint8_t> closed;

  /// By point: points of the same number, of one fibre or of several, are one place. Negative: the
  /// point is not joined. Empty: none is.
  std::vector<std::int32_t> joints;

  /// [m] The points of a joint lie within this of the first of them; at least 0. Unset: within the
  /// largest radius of the segments that meet there, so that each point is inside of another fibre
  /// as far as a tracker's noise is concerned, or within 1e-6 of the largest coordinate there,
  /// which is what single precision and files of few digits round to, if that is more.
  std::optional<double> joint_tolerance;
};

/// A number of a joint that joins nothing, as one point alone has it.
struct LonelyJoint {
  std::int32_t joint = 0;
  std::uint32_t point = 0;  ///< its index among the joints
};

/// The numbers that one point alone has, by point: allowed, but often a mistake that the caller may
/// want to hear of.
/// @param joints as FiberTopology has them
std::vector<LonelyJoint> lonely_joints(const std::vector<std::int32_t>& joints);

}  // namespace fiber
