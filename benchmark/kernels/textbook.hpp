#pragma once

#include <Eigen/Core>

namespace fiber {

/// Distance of two segments [m] as textbooks of collision detection compute it, as a baseline: the
/// parameter on one line from the determinant of the two directions, clamped, then that on the
/// other; squared lengths below an epsilon are those of points; the distance between absolute
/// points.
double textbook_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                         const Eigen::Vector3d& q0, const Eigen::Vector3d& q1);

}  // namespace fiber
