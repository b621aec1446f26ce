#pragma once

#include <string>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// A node of a scene's rods, counted from the rod's first one.
struct NodeOfRod {
  std::uint32_t rod;
  std::uint32_t node;
};

/// Where something may lead a node that it holds in the next frame.
struct Lead {
  Eigen::Vector3d position;  ///< at the end of the frame [m]

  /// Why that is not on the straight way to where the node is wanted, as far as it comes in a
  /// frame; empty if it is. It is not where the fibre, held elsewhere, would be stretched by more
  /// than SimScene::max_strain, and where the place is none or too far away for numbers.
  std::string problem;
};

/// @param held    the node, which is at `from`
/// @param wanted  where it is to go in the end [m]
/// @param fastest [m/s], no faster than what stretches the fibre by max_strain
Lead lead(const SimScene& scene, const NodeOfRod& held, const Eigen::Vector3d& from,
          const Eigen::Vector3d& wanted, double fastest);

/// Looks whether a hold may bring a node from where it is to a target.
/// @param speed [m/s]; 0: within the next step
/// @throws std::invalid_argument naming the value and what is allowed, for a target that is too far
///         away for numbers, or out of the fibre's reach because of another hold, and for a speed
///         that stretches the fibre by more than max_strain
void require_reach(const SimScene& scene, const NodeOfRod& held, const Eigen::Vector3d& target,
                   double speed);

}  // namespace fiber
