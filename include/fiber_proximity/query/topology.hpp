#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// How often one closed fibre is wound around another.
struct LinkingNumber {
  std::uint32_t fiber_a = 0;
  std::uint32_t fiber_b = 0;  ///< larger
  std::int64_t value = 0;     ///< not 0
};

/// The Gauss linking numbers of all pairs of fibres whose number is not 0, sorted by fibre. The
/// last point of each fibre is joined to its first.
///
/// The sum of the signs of the crossings in which a is above b, seen from any side: an integer
/// without error, as the crossings are (see CrossingFinder). Curves that touch have no linking
/// number; theirs is that of curves moved apart by infinitesimal amounts.
std::vector<LinkingNumber> linking_numbers(const FiberAssembly& fibers);

/// Of two closed polygons; the last point is joined to the first [m].
/// @throws std::invalid_argument for fewer than two points, or a bad coordinate
std::int64_t linking_number(const std::vector<Eigen::Vector3d>& curve_a,
                            const std::vector<Eigen::Vector3d>& curve_b);

/// Whether a curve's last point is joined to its first.
enum class CurveEnds { OPEN, CLOSED };

/// The writhe of a polygon: the mean, over all directions of view, of the sum of the signs of its
/// crossings with itself; twice the sum of the Gauss integrals of its pairs of segments (Klenin and
/// Langowski 2000, eq. 13). 0 for curves in a plane and those that are their own mirror image.
/// O(n²); the same for any number of threads.
/// @param points [m] of a magnitude up to FiberAssembly::max_coordinate
double writhe(const std::vector<Eigen::Vector3d>& points, CurveEnds ends = CurveEnds::OPEN);

}  // namespace fiber
