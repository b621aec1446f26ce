#pragma once

#include "fiber_proximity/sim/edge_turn.hpp"
#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Resistance to twist: ½ GJ/l m² at each inner node, with the twist m between the cross-sections
/// of its edges (Bergou et al. 2008, Sect. 4.2; with the time-parallel frames of Bergou et al.
/// 2010, Sect. 5). Adds an unknown angle to each edge; it keeps Rods::angles, directors and the
/// like.
class Twist : public Effect {
 public:
  /// Gives the rods their frames: untwisted, and where a rod is bent, as the shortest rotations
  /// from edge to edge carry the first director.
  /// @throws std::invalid_argument naming the rod whose section does not resist twist or has no
  ///         inertia
  explicit Twist(Rods& rods);

  std::uint32_t values_per_node() const override { return 1; }
  const double* values_of(std::uint32_t node) const override { return &reference_twists_[node]; }
  void energy(const RodPack& rods, const std::vector<SimdBatch>& values,
              SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& values,
                       PackSystem& system) const override;
  void add_forces(const RodPack& rods, const std::vector<SimdBatch>& values,
                  RodForces& forces) const override;

  void end_step(Rods& rods, const TimeStep& step) override;

  /// Twist at an inner node [rad].
  double twist_at(const Rods& rods, std::uint32_t node) const;

 private:
  std::vector<double> reference_twists_;  // of the directors, at nodes; may exceed a turn [rad]
};

/// The director of an edge where it is now.
Eigen::Vector3d current_director(const Rods& rods, std::uint32_t edge);

/// Angle from one vector to another about a unit vector across both, in (-pi, pi] [rad].
double signed_angle(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                    const Eigen::Vector3d& about);

/// The angle that differs by whole turns from the given one and by at most half a turn from
/// another.
double nearest_turn(double angle, double to);

/// The derivative of the twist between two edges by the point after the second is this over twice
/// the second's length; by the point before the first, minus this over twice the first's
/// (Bergou et al. 2008, Eq. 9). It grows without limit where the rod folds, and is cut off there.
Eigen::Vector3d curvature_binormal(const Eigen::Vector3d& tangent_before,
                                   const Eigen::Vector3d& tangent_after);

/// How much current_director() turns about the tangent as the edge changes, against one that does
/// not turn about it: the derivative by the edge's second point; by the first, minus this. It is
/// transported in one turn from where the step began, which is not the same as bit by bit.
Eigen::Vector3d director_turn(const Eigen::Vector3d& start_tangent, const EdgeDirection& edge);

}  // namespace fiber
