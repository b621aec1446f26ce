#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/ros/sim_fibers.hpp"
#include "fiber_proximity/ros/yaml_field.hpp"
#include "fiber_proximity/sim/effects/attachment.hpp"

namespace fiber_proximity_ros {

/// Placements by time [s], which rises. In between straight lines; before and after, the first and
/// the last.
using PlacementPath = std::vector<std::pair<double, fiber::Placement>>;

/// A frame of tf that holds a fibre. What is held is where the frame was last, and turns with it.
struct FollowedFrame {
  std::string frame;
  std::uint32_t rod;                    ///< that it holds
  std::uint32_t node;                   ///< of the rod, from its first one
  std::string what;                     ///< what it holds and where that stands, for warnings
  fiber::Placement in_frame;            ///< what it holds, in the frame
  std::shared_ptr<PlacementPath> path;  ///< in the world, never empty; the hold follows it
};

/// A hold as the scene has it.
struct SimHold {
  fiber::Attachment::Hold hold;
  std::string place;  ///< where it stands, for errors
};

struct SimHolds {
  std::vector<SimHold> holds;
  std::vector<FollowedFrame> frames;
  double fastest = 0.0;  ///< on a path [m/s]
};

/// Reads the options of the effect `attachment`: a list of holds, each of
///   fiber:    name; that of a repeated fibre means each of them
///   node:     first, last, or an index; first if there is none
///   kind:     pin or clamp; pin if there is none
///   position, tangent, director: where and how it is held; where and how the fibre is if there are
///             none
///   path:     a list of {time, position, tangent, director}, in between straight lines; what is
///             not given stays as it was
///   period:   [s] after which the path begins again, to where it leads back from its last entry
///   frame:    of tf, that carries it: position, the frame's origin if there is none, tangent and
///             director are in this frame. As long as tf does not know it, the fibre stays where it
///             is
/// @param rods those of the fibres, as the simulation begins
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
SimHolds read_sim_holds(const YamlField& list, const std::vector<SimFiber>& fibers,
                        const fiber::Rods& rods);

}  // namespace fiber_proximity_ros
