#pragma once

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

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
/// @param scene with its fibres and rods; gets the holds, and the speed of the fastest
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed
void read_holds(const YamlField& list, SimDescription& scene);

/// How something is held, as a function of time [s].
/// @param rods   as the simulation begins; with twist, they have their frames already
/// @param frames gets the frame that is to be followed, if there is one
std::function<Placement(double)> placement_of(const SimHold& hold, const SimDescription& scene,
                                              const Rods& rods, std::vector<FollowedFrame>& frames);

}  // namespace fiber
