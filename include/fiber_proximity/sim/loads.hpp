#pragma once

#include <optional>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "fiber_proximity/sim/time_table.hpp"

namespace fiber {

/// Forces, moments and weights on rods, at nodes or spread along parts of rods.
///
/// A force or moment in time is in each step that of the step's end, as implicit Euler has all
/// forces. Within a step each is the derivative of a potential: of a constant force that is the
/// same in all steps, so that its work may be had back. A moment keeps its direction in the scene,
/// and has no such potential (Ziegler 1968): its potential is made for each step from where the rod
/// is when the step begins. In a plane, and where the rod is at rest, it is exact. Steps beyond
/// half of the rod's slowest period may not lead to rest where a moment is oblique to the rod.
class Loads : public Effect {
 public:
  /// A force, moment or weight at a node, or along a part of a rod.
  struct Load {
    std::uint32_t rod = 0;
    std::uint32_t node = 0;       ///< from the rod's first one, where there is no part
    std::optional<RodPart> part;  ///< over which the load is spread evenly by length at rest

    /// [N], along a part [N/m]; in the scene's frame.
    TimeTable<Eigen::Vector3d> force{Eigen::Vector3d::Zero()};

    /// [N m] in the scene's frame, at an end of the rod only: a couple that turns the edge there.
    /// With twist, its part along the edge turns the edge's cross-section; without, that part has
    /// nothing to act on.
    TimeTable<Eigen::Vector3d> moment{Eigen::Vector3d::Zero()};

    /// About the tangent [N m], along a part [N]; with twist only. At an inner node each of its
    /// edges takes a half.
    TimeTable<double> torque{0.0};

    /// Mass of a weight, which adds to the inertia of nodes [kg], along a part [kg/m]; >= 0.
    double mass = 0.0;
  };

  /// Adds a load, and its mass to that of the rods.
  /// @param rods with twist, have their angles already
  /// @returns the id of the load for the functions below: loads are counted from 0
  /// @throws std::invalid_argument naming rod, node and value, for a rod, node or part that there
  ///         is not, a negative or infinite mass, forces and moments that are not finite, a moment
  ///         that is not at an end, or a torque on rods without twist; nothing is added then
  std::uint32_t add(Rods& rods, const Load& load);

  /// Changes what a load exerts; its mass stays.
  /// @throws std::invalid_argument for values that add() would not take
  void set_force(std::uint32_t load, const Eigen::Vector3d& force);
  void set_moment(std::uint32_t load, const Eigen::Vector3d& moment);
  void set_torque(std::uint32_t load, double torque);

  void begin_step(Rods& rods, const TimeStep& step) override;
  void energy(const RodPack& rods, const NodeValues& values, SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const NodeValues& values,
                       PackSystem& system) const override;
  void add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const override;

 private:
  /// The share that a node and the edge after it have in a load, and what that is in this step.
  struct Share {
    std::uint32_t load;
    std::uint32_t node;       // as Rods counts nodes
    double of_force = 0.0;    // of a part [m]
    double of_torque = 0.0;   // of a part [m]
    bool has_moment = false;  // the node's edge is the one that a moment turns
    Eigen::Vector3d force = Eigen::Vector3d::Zero();  // [N]
    double along = 0.0;   // the part of the moment that turns the cross-section [N m]
    double torque = 0.0;  // [N m]
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();         // [N m]
    Eigen::Vector3d start_tangent = Eigen::Vector3d::Zero();  // when the step began
  };

  Share& share_of(std::uint32_t load, std::uint32_t node);

  template <class Visit>
  void for_each_share(const RodPack& rods, const Visit& visit) const;

  std::vector<Load> loads_;
  std::vector<Share> shares_;  // by node, and by load where they have the same
};

}  // namespace fiber
