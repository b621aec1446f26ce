#pragma once

#include <Eigen/Core>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/environment/world_shape.hpp"

namespace fiber {

/// An axis whose ends move linearly in a shape's frame [m].
struct AxisMotion {
  Eigen::Vector3d before[2];  ///< at time 0
  Eigen::Vector3d after[2];   ///< at time 1
};

/// When a moving axis is in contact with a shape.
struct AxisLimit {
  double distance = 0.0;  ///< [m] they are no further apart; finite, >= 0
  double error = 0.0;     ///< [m] how far the axis may be from where its motion has it; >= 0
};

/// The first contact of a moving axis and a shape, with bounds as of two capsules: none before
/// `lower`; the distance is at most limit and tolerance at `upper`, and where it is `certain`, at
/// most the limit.
///
/// A closed mesh counts by its surface alone: an axis that is inside from the beginning is in
/// contact then, which is for the caller to see.
///
/// Conservative advancement: a plane between the axis and a convex solid that all of the solid is
/// behind proves that there is no contact, until an end of the axis comes through; so does a plane
/// that turns with the axis; and so does the distance, while no end has gone as far. The longest of
/// these steps is taken. A mesh is as many solids as it has triangles near the way, an octree as it
/// has cells. Planes rest on dot products alone, whose rounding is within 128·2⁻⁵² of coordinates
/// and the shape's reach. No contact is missed: after 500 steps there is a hit that is not certain,
/// with an infinite `upper`.
/// @param tolerance [m] >= 0, finite. With 0 a contact is found where it is proven to be one
ContactTime contact_time(const Shape& shape, const AxisMotion& motion, const AxisLimit& limit,
                         double tolerance);

/// A fibre's segment, both ends of which move linearly, and a shape that may move as well.
struct SegmentAndShape {
  Capsule before;
  Capsule after;
  const WorldShape& shape;
  const ObjectPath* path;  ///< of the object; null where it stands still
};

/// The first contact of their motion: as contact_time() of an axis and a shape. Where the shape
/// turns, the motion is halved, the earlier half first, until the axis moves nearly straight in the
/// shape's frame or is proven to be free.
/// @param distance  [m] of the segment's axis from the shape, at most which there is contact
/// @param tolerance [m] where the shape turns, more than 0: otherwise it would be halved for ever
ContactTime contact_time(const SegmentAndShape& pair, double distance, double tolerance);

}  // namespace fiber
