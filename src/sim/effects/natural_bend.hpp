#pragma once

#include "src/sim/effects/cross_section.hpp"

namespace fiber {

/// Bending of a rod with Rods::natural_curvature_vectors between two cross-sections a length l
/// apart: ½ EI/l |r|², r = (t₂ − t̂₂ − t₁ + t̂₁) / 2 cos(φ₀/2), with their tangents t, the tangents t̂
/// that each would have as the other cross-section has it by nature, and the angle φ₀ between them
/// then. As Bergou et al. (2008, Sect. 4.2) do with their material curvatures it averages over both
/// cross-sections, but before it squares: twist between them would be stiffer otherwise. In the
/// plane of the natural bend it is the energy of Bend for the excess of the angle; without natural
/// curvature it is that of Bend.
class NaturalBend {
 public:
  /// @param node      an inner one
  /// @param curvature natural, along the material directions [1/m]
  static NaturalBend at_node(const PackLane& rod, std::uint32_t node,
                             const Eigen::Vector2d& curvature);

  /// At a clamp, which is an edge before the first or after the last one, half an edge's length of
  /// rod away.
  /// @param node an end of the rod
  static NaturalBend at_clamp(const PackLane& rod, std::uint32_t node,
                              const Eigen::Vector2d& curvature, const CrossSection& clamp);

  double energy() const { return 0.5 * stiffness_ * residual_.squaredNorm(); }

  /// The moment about which the cross-section after the place turns that before it [N m].
  Eigen::Vector3d moment() const;

  /// Adds the gradient of the energy, and what is left of its Hessian without second derivatives of
  /// what is squared (Gauss-Newton).
  void add_derivatives(RodSystem& system) const;

 private:
  NaturalBend(const PackLane& rod, std::uint32_t node, const Eigen::Vector2d& curvature,
              double length, const CrossSection& before, const CrossSection& after);

  PackLane rod_;
  std::uint32_t node_;
  double stiffness_;  // EI/l
  Eigen::Vector3d before_;
  Eigen::Vector3d after_;
  Eigen::Vector3d natural_before_;  // the tangent that the cross-section after would have before it
  Eigen::Vector3d natural_after_;
  double weight_;
  Eigen::Vector3d residual_;
};

/// Makes the shape that each rod has now its natural one, in which it is at rest. With twist, that
/// is all of it but a twist between cross-sections, which should be none now; without, the size of
/// the curvature at each node. A clamp finds the rod at rest that continues its outermost edge.
/// @param rods with twist, have their frames already
void set_natural_shape(Rods& rods);

/// Makes an arc the natural shape of a rod with twist. The cross-sections take the side to which it
/// bends with them.
/// @param curvature [1/m]
/// @param towards   to which side of its first edge the rod is to bend; of any length
/// @throws std::invalid_argument for rods without twist, a curvature that is negative or not
///         finite, and a side that is not finite or along the edge
void set_natural_arc(Rods& rods, std::uint32_t rod, double curvature,
                     const Eigen::Vector3d& towards);

}  // namespace fiber
