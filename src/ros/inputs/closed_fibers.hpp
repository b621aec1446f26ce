#pragma once

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {

/// Closes the open fibres of four points or more that end exactly where they begin, as trackers and
/// markers without a word for it draw a ring: their last point goes. Fibres that lie about their
/// own layout stay as they are.
void close_rings(FiberBuffer& fibers);

/// Opens closed fibres: their first point comes again behind their last one, and a joint of its own
/// joins the two.
/// @param fibers of a sound layout
void open_rings(FiberBuffer& fibers);

/// Whether offsets, closed, joints and radii have the numbers of values that they must have.
bool has_sound_layout(const FiberBuffer& fibers);

}  // namespace fiber_proximity_ros
