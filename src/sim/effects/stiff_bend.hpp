#pragma once

#include "src/sim/effects/cross_section.hpp"

namespace fiber {

/// The energy of bending between two cross-sections towards a stiff side beyond that of bending
/// across it: ½ k (ρ − ρ₀)², see AnisotropicBend.
class StiffBend {
 public:
  /// ρ between two cross-sections.
  static double strain(const StiffSide& side, const CrossSection& before,
                       const CrossSection& after);

  /// ρ₀ of natural curvature over a length [m].
  /// @param curvature along the material directions [1/m]
  static double rest(const StiffSide& side, const Eigen::Vector2d& curvature, double length);

  /// @param node an inner one
  static StiffBend at_node(const PackLane& rod, std::uint32_t node, const StiffSide& side,
                           double rest);

  /// At a clamp, half an edge's length of rod away.
  /// @param node an end of the rod
  static StiffBend at_clamp(const PackLane& rod, std::uint32_t node, const StiffSide& side,
                            double rest, const CrossSection& clamp);

  double energy() const { return 0.5 * stiffness_ * residual_ * residual_; }

  /// The moment about which the cross-section after the place turns that before it [N m].
  Eigen::Vector3d moment() const { return -stiffness_ * residual_ * by_rotation_; }

  /// Adds the gradient of the energy, and what is left of its Hessian without second derivatives of
  /// what is squared (Gauss-Newton).
  void add_derivatives(RodSystem& system) const;

 private:
  StiffBend(const PackLane& rod, std::uint32_t node, const StiffSide& side, double rest,
            const CrossSection& before, const CrossSection& after);

  PackLane rod_;
  std::uint32_t node_;
  double stiffness_;
  double residual_;
  Eigen::Vector3d by_rotation_;  // of the cross-section before; of that after it is minus this
};

}  // namespace fiber
