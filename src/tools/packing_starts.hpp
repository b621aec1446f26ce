#pragma once

#include <Eigen/Core>
#include <vector>

#include "src/scenes/random.hpp"

namespace fiber {

/// Unit vectors along independent random lines, uniform over the sphere.
std::vector<Eigen::Vector3d> random_lines(int count, Random& random);

/// Lines which a random finite group of rotations maps onto each other: orbits of random size as
/// far as they fit, independent lines for the rest. Many of the best packings are of this kind, and
/// few random starts lead there.
std::vector<Eigen::Vector3d> symmetric_lines(int count, Random& random);

/// A packing with a few of its lines, next to one another, put somewhere else.
std::vector<Eigen::Vector3d> disturbed_lines(std::vector<Eigen::Vector3d> lines, Random& random);

}  // namespace fiber
