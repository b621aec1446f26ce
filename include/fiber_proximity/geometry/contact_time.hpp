#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <limits>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Two capsules whose end points each move linearly from where they are before, at time 0, to where
/// they are after, at time 1. Refers to the points: to the two ends of each segment, one after the
/// other [m].
struct SegmentMotions {
  const Eigen::Vector3d* a_before;
  const Eigen::Vector3d* a_after;
  const Eigen::Vector3d* b_before;
  const Eigen::Vector3d* b_after;
  ContactLimit limit;  ///< contact is a gap of at most limit.margin; radii and margin together >= 0
};

/// When the gap of two moving capsules first falls to the margin, as a part of the motion.
struct ContactTime {
  /// False: the gap is above the margin throughout.
  bool hit = false;

  /// There is no contact before this; 1 without a hit.
  double lower = 1.0;

  /// The gap is at most margin + tolerance at this time; infinity if no such time was found, or
  /// without a hit.
  double upper = std::numeric_limits<double>::infinity();

  /// For a hit: there is a contact, the margin included, no later than `upper`; otherwise the
  /// capsules may also only come as near as margin + tolerance. Without a hit: true.
  bool certain = true;
};

/// The first contact of two capsules that move linearly; continuous collision detection.
///
/// The vectors from one segment to the other fill a parallelogram, of which the corners are those
/// between end points, and the segments are as far apart as it is from the origin. Where a plane
/// whose distance from the origin is larger than radii and margin has all four corners beyond it,
/// there is no contact. From the nearest points of one time follow such a plane and how it turns
/// with the segments, and from these, for each corner, a quadratic equation for when it comes
/// through: until then there is no contact, and that is the next time to look at. This is
/// conservative advancement (Mirtich 1996) with a plane that turns instead of a bound on speed:
/// near a contact it converges quadratically, and where segments graze each other still by a
/// factor.
///
/// No contact is missed: the step from one time to the next rests on dot products alone, whose
/// rounding is proven to be less than 64·2⁻⁵² of coordinates and limit (docs/numerics.md); where
/// that is not little enough, the motion goes on in numbers of twice the digits. A contact at time
/// 0 is decided exactly. Times are doubles: a contact between two of them is found where the
/// capsules overlap at the second one, or, of segments without thickness that cross, where the
/// tolerance is more than they move meanwhile. If it is not, `upper` is infinite.
///
/// Gives the same bits on every instruction set and in any batch. Valid for coordinates up to
/// FiberAssembly::max_coordinate, which is not checked.
/// @param tolerance [m]
/// @throws std::invalid_argument for a tolerance that is negative or not a number
ContactTime contact_time(const SegmentMotions& motions, double tolerance);

/// contact_time() of many pairs at once, faster.
void contact_times(const SegmentMotions* motions, std::size_t count, double tolerance,
                   ContactTime* times);

}  // namespace fiber
