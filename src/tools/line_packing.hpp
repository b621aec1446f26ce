#pragma once

#include <Eigen/Core>
#include <vector>

namespace fiber {

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

}  // namespace fiber
