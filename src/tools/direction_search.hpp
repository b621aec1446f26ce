#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/scenes/random.hpp"

namespace fiber {

double in_degrees(double radians);

/// The best packing of `count` lines found by this many local searches from independent,
/// symmetric and disturbed starts.
/// @param known a packing to improve on, or empty; returned if nothing better is found
std::vector<Eigen::Vector3d> search_directions(int count, const std::vector<Eigen::Vector3d>& known,
                                               int starts, Random& random);

/// The packing, unless one of one line more has a larger angle: then the best of as many lines that
/// comes from leaving out one of those.
std::vector<Eigen::Vector3d> better_of_fewer(const std::vector<Eigen::Vector3d>& lines,
                                             const std::vector<Eigen::Vector3d>& one_more);

/// The packing turned so that no line comes near a coordinate axis, as unit vectors with z > 0, in
/// an order in which each is as far as possible from all before it.
std::vector<Eigen::Vector3d> arranged_directions(const std::vector<Eigen::Vector3d>& lines,
                                                 Random& random);

}  // namespace fiber
