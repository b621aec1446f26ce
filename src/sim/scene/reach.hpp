#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// The sphere that a rod can reach with one of its nodes: another node is held at its center.
struct ReachLimit {
  std::uint32_t rod;       ///< that is held, or joined with it
  std::uint32_t node;      ///< that is held, from the rod's first one
  Eigen::Vector3d center;  ///< where it is held [m]
  double rest_length;      ///< of the rod between [m]
  double radius;           ///< rest_length · (1 + strain) [m]

  bool allows(const Eigen::Vector3d& position) const {
    return (position - center).norm() <= radius;
  }
};

/// Length at rest of a rod between two of its nodes, which are counted from its first one [m].
double rest_length_between(const Rods& rods, std::uint32_t rod, std::uint32_t node,
                           std::uint32_t other);

/// The least lengths at rest from a node to all others along rods and through joints, infinite
/// where none lead there [m].
/// @param node from the rod's first one
/// @returns by node, as Rods counts nodes
std::vector<double> lengths_from(const Rods& rods, std::uint32_t rod, std::uint32_t node);

/// Length at rest of a whole rod [m].
double rest_length(const Rods& rods, std::uint32_t rod);

/// The limits of a node by the other holds of its rod and of those it is joined with, by rising
/// node.
/// @param node   from the rod's first one
/// @param time   when they hold [s]
/// @param strain the most by which they may stretch the rod together
std::vector<ReachLimit> reach_limits(const Rods& rods, const Attachment& attachment,
                                     std::uint32_t rod, std::uint32_t node, double time,
                                     double strain);

/// The largest share of the straight way from one place to another that the limits allow, in
/// [0, 1]. From a place out of reach, what leads no further out is allowed.
double reachable_share(const std::vector<ReachLimit>& limits, const Eigen::Vector3d& from,
                       const Eigen::Vector3d& to);

/// A node that is suddenly moved along the rod at a speed v stretches it by v / c, c being the
/// speed of sound in it (Kolsky, Stress Waves in Solids, 1963, ch. 3): the speed that brings it to
/// a strain [m/s].
double pull_speed(const RodSection& section, double strain);

/// The largest stretch of an edge, in parts of its length at rest; 0 where none is stretched.
struct LargestStrain {
  double strain = 0.0;
  std::uint32_t rod = 0;
  std::uint32_t edge = 0;  ///< from the rod's first one
};
LargestStrain largest_strain(const Rods& rods);

/// A node of a rod, counted from the rod's first one.
struct NodeOfRod {
  std::uint32_t rod;
  std::uint32_t node;
};

/// The rod of a fibre by its name.
/// @throws std::invalid_argument naming a fibre that is not there
std::uint32_t find_rod(const SimScene& scene, const std::string& fiber);

/// The node of a rod by its index; negative indices count from the end.
/// @throws std::invalid_argument naming fibre and index if there is no such node, and for a scene
///         without the effect attachment
NodeOfRod find_node(const SimScene& scene, std::uint32_t rod, std::int64_t index);

/// The position of a node [m].
inline const Eigen::Vector3d& position_of(const Rods& rods, const NodeOfRod& node) {
  return rods.positions[rods.first(node.rod) + node.node];
}

/// Holds a node of a scene with the effect attachment on a path, which may change later. Replaces
/// the node's hold if it has one.
void hold_on_path(SimScene& scene, const NodeOfRod& node,
                  const std::shared_ptr<const PlacementPath>& path);

/// Removes a hold.
/// @throws std::invalid_argument if there is no such hold
void remove_hold(SimScene& scene, std::uint32_t id);

/// Removes the hold of the node that find_node() finds.
/// @throws std::invalid_argument as find_node(), and if nothing holds the node
void release_node(SimScene& scene, std::uint32_t rod, std::int64_t index);

/// How far a hold may move its node in the next frame.
struct Lead {
  Eigen::Vector3d position;  ///< at the end of the frame [m]

  /// Why the node does not go as far towards the wanted position as the speed allows; empty if it
  /// does. It stops where the fibre, held elsewhere, would be stretched by more than
  /// SimScene::max_strain, and does not move for coordinates that are not finite or too large.
  std::string problem;
};

/// @param held    the node, which is at `from`
/// @param wanted  where it is to go in the end [m]
/// @param fastest [m/s], no faster than what stretches the fibre by max_strain
Lead lead(const SimScene& scene, const NodeOfRod& held, const Eigen::Vector3d& from,
          const Eigen::Vector3d& wanted, double fastest);

/// Checks that a hold may move a node from where it is to a target.
/// @param speed [m/s]; 0: within the next step
/// @throws std::invalid_argument naming the value and what is allowed, for a target with
/// coordinates
///         that are not finite or too large, or out of the fibre's reach because of another hold,
///         and for a speed that stretches the fibre by more than max_strain
void require_reach(const SimScene& scene, const NodeOfRod& held, const Eigen::Vector3d& target,
                   double speed);

}  // namespace fiber
