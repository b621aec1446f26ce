#pragma once

#include <functional>
#include <optional>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Where something that holds a rod is.
struct Placement {
  Eigen::Vector3d position;  ///< [m]
  Eigen::Vector3d tangent;   ///< of clamps: the rod's direction there, a unit vector
  Eigen::Vector3d director;  ///< of clamps of rods with twist: across the tangent, a unit vector
};

/// Holds on rods: pins, which fix where a node is; clamps, which at an end of a rod fix its
/// direction too, and with twist how the cross-section lies.
///
/// A clamp is an edge before the first or after the last one that meets it at the end node, half an
/// edge's length of rod away: fixing two nodes instead would move the clamp by half an edge.
class Attachment : public Effect {
 public:
  enum class Kind { PIN, CLAMP };

  struct Hold {
    std::uint32_t rod = 0;
    std::uint32_t node = 0;  ///< from the rod's first one
    Kind kind = Kind::PIN;
    std::function<Placement(double time)> placement;  ///< by time [s]
  };

  /// Nothing is held.
  Attachment() = default;

  /// @returns what to remove it by
  /// @throws std::invalid_argument naming the hold, for a rod or node that there is not, a clamp
  ///         that is not at an end, a node that is held already, or a first placement that is not
  ///         finite or whose vectors are not of unit length
  std::uint32_t add(const Rods& rods, const Hold& hold);

  /// What holds this node, counted from the rod's first one.
  std::optional<std::uint32_t> find(std::uint32_t rod, std::uint32_t node) const;

  /// The nodes of a rod that are held, rising, counted from the rod's first one, and where they are
  /// to be at a time [s].
  std::vector<HeldNode> held_at(std::uint32_t rod, double time) const;

  /// @throws std::invalid_argument if there is no such hold
  void remove(std::uint32_t id);

  /// @throws std::invalid_argument naming the hold, for a placement that add() would not take
  void begin_step(Rods& rods, const TimeStep& step) override;
  double energy(const Rods& rods, std::uint32_t rod) const override;
  void add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const override;

  bool works_in_lanes(const Rods& rods) const override {
    return rods.natural_curvature_vectors.empty();
  }
  void energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                       Lanes& energy) const override;
  void add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                LaneSystem& system) const override;

  void end_solve(const Rods& rods, std::uint32_t rod) override;
  void end_step(Rods& rods, const TimeStep& step) override;

 private:
  struct Held {
    std::uint32_t id;
    Hold hold;
    Placement placement;     // at the end of this step
    double solved_at = 0.0;  // the time that the rod was solved for last [s], and where it was held
    Eigen::Vector3d solved_position = Eigen::Vector3d::Zero();
    double twist = 0.0;  // between clamp and edge when the step began, may exceed a turn [rad]
  };

  /// Implicit midpoint solves for the middle of a step: from there to its end the path of a hold
  /// need not be straight.
  void place_at_end(Rods& rods, Held& held, const TimeStep& step) const;

  /// The first hold of a rod, or of one after it.
  std::vector<Held>::const_iterator first_of(std::uint32_t rod) const;

  template <class Visit>
  void for_each_clamp(std::uint32_t rod, const Visit& visit) const;

  std::vector<Held> held_;    // by rod and node
  double solving_for_ = 0.0;  // the time of the placements [s]
  std::uint32_t next_id_ = 0;
};

}  // namespace fiber
