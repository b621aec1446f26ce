#pragma once

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/view.hpp"

namespace fiber {

/// Fibres as a view shows them, for a broad phase: the capsules of two segments of the image touch
/// if the view shows a common point of the segments' axes. The view is valid.
///
/// Along parallel rays the image is in a plane, in units of the fibres' extent. Axes with a common
/// point have images with one; rounding moves a point of the image by less than 2^-46, and the
/// radius is 2^-42, which leaves enough for a kernel's error.
///
/// From an eye the image is on the unit sphere around it, so what is near the plane of the eye
/// needs no clipping. A segment is seen as an arc of a great circle, of angle θ, and its capsule is
/// that of the chord c. No point of the arc is further from the chord than 1 − cos(θ/2), which is
/// at most sin²(θ/2) = c²/4; the radius is that and 2^-42 for rounding. An end in the eye itself is
/// seen nowhere: such a segment has a capsule around all of the sphere.
/// @param image overwritten in the memory it has; of the same offsets
void make_view_image(const FiberAssembly& fibers, const View& view, FiberAssembly& image);

}  // namespace fiber
