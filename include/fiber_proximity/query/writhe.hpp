#pragma once

#include <Eigen/Core>
#include <vector>

namespace fiber {

/// Whether a curve's last point is joined to its first.
enum class CurveEnds { OPEN, CLOSED };

/// The writhe of a polygon: the mean, over all directions of view, of the sum of the signs of its
/// crossings with itself; twice the sum of the Gauss integrals of its pairs of segments (Klenin and
/// Langowski 2000, eq. 13). 0 for curves in a plane and those that are their own mirror image.
/// O(n²); the same for any number of threads.
/// @param points [m] of a magnitude up to FiberAssembly::max_coordinate
double writhe(const std::vector<Eigen::Vector3d>& points, CurveEnds ends = CurveEnds::OPEN);

}  // namespace fiber
