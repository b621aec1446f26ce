#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fiber {

/// The forces inside of rods and on them at the end of a step.
struct RodForces {
  /// A contact of a rod, and the forces in it.
  struct ContactForce {
    static constexpr std::uint32_t obstacle = 0xffffffff;

    std::uint32_t rod;
    std::uint32_t edge;              ///< from the rod's first one
    std::uint32_t other_rod;         ///< that it touches, or `obstacle`: an object
    std::uint32_t other_edge;        ///< from that rod's first one; of obstacles 0
    std::uint32_t object;            ///< of the environment, where it touches one; else 0
    Eigen::Vector3d point;           ///< between the surfaces [m]
    Eigen::Vector3d normal_force;    ///< on `rod`; on the other minus this [N]
    Eigen::Vector3d friction_force;  ///< on `rod` [N]
  };

  /// The force and moment of a hold on its rod.
  struct HoldForce {
    std::uint32_t hold;  ///< as Attachment::add() calls it
    std::uint32_t rod;
    std::uint32_t node;      ///< from the rod's first one
    Eigen::Vector3d point;   ///< of the rod's node [m]
    Eigen::Vector3d force;   ///< [N]
    Eigen::Vector3d moment;  ///< about the node [N m]
    double lag;              ///< of the node from where the hold pulls it [m]
    double max_force;        ///< with which the hold pulls at most [N]
  };

  /// The force and the moment that rods exert on an object that moves.
  struct ObstacleForce {
    std::uint32_t object;    ///< as ContactForce counts them
    Eigen::Vector3d point;   ///< the origin of the object [m]
    Eigen::Vector3d force;   ///< [N]
    Eigen::Vector3d moment;  ///< about the origin [N m]
  };

  /// The share of a load that acts at a node and on the edge after it.
  struct LoadForce {
    std::uint32_t load;  ///< as Loads::add() counts them
    std::uint32_t rod;
    std::uint32_t node;      ///< from the rod's first one
    Eigen::Vector3d point;   ///< of the node [m]
    Eigen::Vector3d force;   ///< [N]
    Eigen::Vector3d moment;  ///< on the edge after the node [N m]
  };

  /// The force and moment of a joint on one of its nodes.
  struct JointForce {
    std::uint32_t joint;  ///< as Joints::add() calls it
    std::uint32_t rod;
    std::uint32_t node;      ///< from the rod's first one
    Eigen::Vector3d point;   ///< the place of the joint [m]
    Eigen::Vector3d force;   ///< [N]
    Eigen::Vector3d moment;  ///< about the place, of welds [N m]
  };

  /// The force, by edge, with which the part of the rod after the edge pulls at the part before it,
  /// along the edge; negative under pressure [N].
  std::vector<double> tensions;

  /// The moment, by node, with which the part of the rod after it bends the part before it [N m].
  std::vector<Eigen::Vector3d> bending_moments;

  /// The moment, by edge, with which the part of the rod after its first node twists that edge,
  /// about the tangent [N m].
  std::vector<double> twisting_moments;

  std::vector<ContactForce> contacts;
  std::vector<HoldForce> holds;
  std::vector<LoadForce> loads;
  std::vector<JointForce> joints;        ///< those of a joint add up to 0
  std::vector<ObstacleForce> obstacles;  ///< one of each object that moves
};

}  // namespace fiber
