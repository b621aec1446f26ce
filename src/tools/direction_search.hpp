#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/scenes/portable_math.hpp"

namespace fiber {

double in_degrees(double radians);

/// Moves lines through the origin of R³, given by unit vectors, to a local maximum of the smallest
/// angle between any two: a packing in the Grassmannian space G(3,1) (Conway, Hardin and Sloane
/// 1996). Converges to well below 1e-9 rad of that maximum. Only the angles are determined; the set
/// as a whole is free to turn.
/// @param smoothness how far the surface is levelled at the start: 1 forgets the details of the
///   start, small values keep to its neighbourhood
/// @param target [rad] gives up, and returns what it has, once it heads for a smaller angle than
///   this; 0 never gives up
std::vector<Eigen::Vector3d> pack_lines(std::vector<Eigen::Vector3d> lines, double smoothness,
                                        double target);

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
