#pragma once

#include <Eigen/Core>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// The Gauss integral of two segments p0–p1 and q0–q1 over 4π: the mean, over all directions of
/// view, of the sign of the crossing they are seen to have, or 0 where they have none.
///
/// The differences of their points make a parallelogram, and the integral is the solid angle under
/// which it is seen from the origin (Banchoff 1976; Klenin and Langowski 2000, method 1a). That is
/// computed as two triangles' (van Oosterom and Strackee 1983), which needs no case for segments
/// that are parallel, collinear or of no length; or, where these say little because the segments
/// pass each other closely, from the angles between the faces, as method 1a does. In [−1/2, 1/2].
/// The error is some roundings of 1 for segments that are not nearer to each other than a rounding
/// of their extent. Segments in one plane have 0, touching ones too.
FIBER_PROXIMITY_EXPORT double gauss_integral(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                             const Eigen::Vector3d& q0, const Eigen::Vector3d& q1);

}  // namespace fiber
