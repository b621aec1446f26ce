#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// The position and, for clamps, the orientation of a hold.
struct Placement {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d tangent;   ///< for clamps: the rod's direction, a unit vector
  Eigen::Vector3d director;  ///< for clamps of rods with twist: a unit vector across the tangent
};

/// A node that is held, and its target.
struct HeldNode {
  std::uint32_t node;        ///< from the rod's first one
  Eigen::Vector3d position;  ///< [m]
};

/// A hold that pulls with its maximum force without bringing its node to the target.
struct HoldLag {
  std::uint32_t rod;
  std::uint32_t node;  ///< from the rod's first one
  double distance;     ///< of the node from there [m]
  double force;        ///< [N]
};

/// Holds on rods: pins, which pull a node to a place; clamps, which at an end of a rod also turn it
/// into a direction, and with twist turn the cross-section.
///
/// A hold pulls like a spring that is far stiffer than the rod's edges, up to a maximum force: a
/// node that something stronger keeps lags behind, and the rod is not torn. The potential is the
/// Huber loss of the distance.
///
/// A clamp is an edge before the first or after the last one that meets it at the end node, half an
/// edge's length of rod away: fixing two nodes instead would move the clamp by half an edge.
class Attachment : public Effect {
 public:
  enum class Kind { PIN, CLAMP };

  /// A hold of one node.
  struct Hold {
    std::uint32_t rod = 0;
    std::uint32_t node = 0;  ///< from the rod's first one
    Kind kind = Kind::PIN;
    std::function<Placement(double time)> placement;  ///< by time [s]
    double max_force = 0.0;  ///< [N] >= 0; 0: what stretches the rod by `default_strain`
  };
  static constexpr double default_strain = 0.1;

  /// Nothing is held.
  Attachment() = default;

  /// @returns the id for remove()
  /// @throws std::invalid_argument naming the hold, for a rod or node that there is not, a clamp
  ///         that is not at an end, a node that is held already, a force that is negative or not
  ///         finite, or a first placement that is not finite or whose vectors are not of unit
  ///         length
  std::uint32_t add(const Rods& rods, const Hold& hold);

  /// The id of the hold of this node, counted from the rod's first one; none if it is free.
  std::optional<std::uint32_t> find(std::uint32_t rod, std::uint32_t node) const;

  /// All held nodes as (rod, node), counted from the rod's first one; rising.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> held_nodes() const;

  /// The held nodes of a rod, rising, with their targets at a time [s].
  std::vector<HeldNode> held_at(std::uint32_t rod, double time) const;

  /// The hold that lags furthest behind, of those that pull with their maximum force; none if there
  /// is none.
  std::optional<HoldLag> longest_lag(const Rods& rods) const;

  /// Has a hold go another way from the next step on; its node and what it does stay as they are.
  /// @param placement by time [s]
  /// @throws std::invalid_argument if there is no such hold
  void redirect(std::uint32_t id, std::function<Placement(double time)> placement);

  /// Where a hold has its node at a time [s].
  /// @throws std::invalid_argument if there is no such hold
  Placement placement(std::uint32_t id, double time) const;

  /// @throws std::invalid_argument if there is no such hold
  void remove(std::uint32_t id);

  /// @throws std::invalid_argument naming the hold, for a placement that add() would not take
  void begin_step(Rods& rods, const TimeStep& step) override;
  void energy(const RodPack& rods, const NodeValues& values, SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const NodeValues& values,
                       PackSystem& system) const override;
  bool holds(std::uint32_t rod) const override;
  void end_step(Rods& rods, const TimeStep& step) override;
  void take_state(const Effect& other) override;
  void add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const override;

 private:
  struct Held {
    std::uint32_t id;
    Hold hold;
    double max_force;        // [N]
    double stiffness = 0.0;  // [N/m]
    Placement placement;     // at the end of this step
    double twist = 0.0;      // between clamp and edge when the step began, may exceed a
                             // turn [rad]
    std::optional<Eigen::Vector2d> natural_bend{};  // of clamps, if it has a direction [1/m]
    StiffSide stiff_side{};                         // of clamps

    bool is_clamp() const { return hold.kind == Kind::CLAMP; }
    Eigen::Vector3d pull_at(const Eigen::Vector3d& position) const;
  };

  std::vector<Held>::const_iterator by_id(std::uint32_t id) const;

  /// The first hold of a rod, or of the next rod that has one.
  std::vector<Held>::const_iterator first_of(std::uint32_t rod) const;

  template <class Visit>
  void for_each_held(const RodPack& rods, const Visit& visit) const;

  std::vector<Held> held_;  // by rod and node
  std::uint32_t next_id_ = 0;
};

}  // namespace fiber
