// Ropes between joints that are free and places that are given.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace fiber {

/// Ropes that pull and do not push, between ends: the joints first, which ropes move, then places
/// where something holds them.
struct RopeNet {
  struct Rope {
    std::size_t from = 0;
    std::size_t to = 0;
    double length = 0.0;  ///< the most by which its ends are apart [m]
  };
  std::size_t joint_count = 0;
  std::vector<Rope> ropes;
};

/// Tensions of a net whose held places are so far apart that its joints have nowhere to be: by
/// rope, that of one that stretches where all do alike, 0 of those that are slack.
///
/// The tensions are a proof. Forces that are in equilibrium at each joint do no work where joints
/// move: where Σ t_i d_i > Σ t_i l_i, with the distances d_i and lengths l_i, some rope is too
/// short wherever the joints are. Such tensions are those where the energy of ropes, 1/2 Σ k_i
/// max(0, d_i - l_i)², is least. It is convex, and Newton's method finds that.
///
/// @param ends by end, joints where they are to begin with [m]
/// @returns empty where it is not proven: there are places, or too little is missing to tell
std::vector<double> tearing_tensions(const RopeNet& net, std::vector<Eigen::Vector3d> ends);

}  // namespace fiber
