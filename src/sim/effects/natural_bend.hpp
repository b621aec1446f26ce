#pragma once

#include "fiber_proximity/sim/rod_system.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// What is across a rod or a clamp: the tangent there, and the material directions.
struct CrossSection {
  Eigen::Vector3d tangent;
  Eigen::Vector3d first;
  Eigen::Vector3d second;  ///< tangent x first
};

/// That of an edge of a rod with twist, where it is now.
CrossSection cross_section(const Rods& rods, std::uint32_t edge);

/// Bending of a rod with Rods::natural_curvature_vectors between two cross-sections a length l
/// apart: ½ EI/l |r|², r = (t₂ − t̂₂ − t₁ + t̂₁) / 2 cos(φ₀/2), with their tangents t, the tangents t̂
/// that each would have as the other cross-section has it by nature, and the angle φ₀ between them
/// then. As Bergou et al. (2008, Sect. 4.2) do with their material curvatures it averages over both
/// cross-sections, but before it squares: twist between them would be stiffer otherwise. In the
/// plane of the natural bend it is the energy of Bend for the excess of the angle; without natural
/// curvature it is that of Bend.
class NaturalBend {
 public:
  /// @param node an inner one, counted from the rod's first
  static NaturalBend at_node(const Rods& rods, std::uint32_t rod, std::uint32_t node);

  /// At a clamp, which is an edge before the first or after the last one, half an edge's length of
  /// rod away.
  /// @param node an end of the rod, counted from its first node
  static NaturalBend at_clamp(const Rods& rods, std::uint32_t rod, std::uint32_t node,
                              const CrossSection& clamp);

  double energy() const { return 0.5 * stiffness_ * residual_.squaredNorm(); }

  /// Adds the gradient of the energy, and what is left of its Hessian without second derivatives of
  /// what is squared (Gauss-Newton).
  void add_derivatives(RodSystem& system) const;

 private:
  NaturalBend(const Rods& rods, std::uint32_t rod, std::uint32_t node, double length,
              const CrossSection& before, const CrossSection& after);

  const Rods& rods_;
  std::uint32_t rod_;
  std::uint32_t node_;
  double stiffness_;  // EI/l
  Eigen::Vector3d before_;
  Eigen::Vector3d after_;
  Eigen::Vector3d natural_before_;  // the tangent that the cross-section after would have before it
  Eigen::Vector3d natural_after_;
  double weight_;
  Eigen::Vector3d residual_;
};

}  // namespace fiber
