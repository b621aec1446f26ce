#pragma once

#include <cstdint>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {

/// How points are treated that a tracker has lost sight of: those with a coordinate that is not
/// finite.
enum class MissingPoints {
  REFUSE,  ///< the message is refused
  BRIDGE,  ///< the neighbours of missing points are joined, missing ends are left off
  SPLIT    ///< the fibre is cut into the pieces that are known
};

/// Counts of missing points in all messages so far.
struct MissingPointCounts {
  std::uint64_t points = 0;
  std::uint64_t gaps = 0;         ///< of these points, those that no bridge stands in for
  std::uint64_t fibers = 0;       ///< left out: fewer than two of their points are known
  std::uint64_t lone_points = 0;  ///< known, but left out: no neighbour of theirs is known
};

/// Refuses, bridges or cuts at the missing points. Fibres that lie about their own layout stay as
/// they are: the assembly refuses them.
///
/// A fibre that is cut keeps its name for the first of its pieces; another piece is called
/// `name[i]`, where i is the index its first point had in the message's fibre, so that names are
/// unique and the same piece has the same name whatever else is missing. A radius goes with its
/// point, or with the pieces of its fibre, a joint with its point. A closed fibre that is bridged
/// stays closed while it has three points. One that is to be cut is opened at its first point,
/// which both of its ends have then, joined; all closed fibres of its message are.
/// @throws std::invalid_argument naming the first of the missing points if they are to be refused
void resolve_missing_points(MissingPoints policy, FiberBuffer& fibers, MissingPointCounts& counts);

}  // namespace fiber_proximity_ros
