#pragma once

#include <Eigen/Core>
#include <vector>

namespace fiber {

/// The N = k/2 unit normals of a k-DOP's slabs (paper, Sect. 4.2.1): N lines through the origin
/// packed so that the smallest angle between any two is as large as known, turned so that none
/// comes near a coordinate axis. The first few are spread widest, so that an overlap test which
/// takes them in order meets a separating slab early.
/// The reference stays valid; may be called from several threads at once.
/// @param k even, from 6 to 200
/// @throws std::invalid_argument for any other k
const std::vector<Eigen::Vector3d>& grassmannian_directions(int k);

/// The k/2 unit normals of the standard k-DOPs of Klosowski et al. (1998), all along {-1, 0, 1}³:
/// the coordinate axes (6), with the cube's diagonals (14), with the diagonals of its faces (18),
/// or with both (26). The coordinate axes come first.
/// @throws std::invalid_argument for any other k
const std::vector<Eigen::Vector3d>& classic_directions(int k);

}  // namespace fiber
