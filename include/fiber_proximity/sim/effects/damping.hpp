#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Internal friction of a Kelvin–Voigt material: each stiffness resists the rate of its strain as
/// well, with a relaxation time. Rigid motion is not damped, but for a bent rod's turning about its
/// own tangents: cross-sections are taken not to turn about them. Nor is a fold, which has no
/// direction.
class Damping : public Effect {
 public:
  /// @param relaxation_time of stretch and bend [s]
  /// @throws std::invalid_argument if it is negative or not finite
  explicit Damping(double relaxation_time);

  void begin_step(Rods& rods, const TimeStep& step) override;
  bool is_stored() const override { return false; }
  std::uint32_t values_per_node() const override { return 7; }
  const double* values_of(std::uint32_t node) const override;
  void energy(const RodPack& rods, const std::vector<SimdBatch>& values,
              SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& values,
                       PackSystem& system) const override;
  void add_forces(const RodPack& rods, const std::vector<SimdBatch>& values,
                  RodForces& forces) const override;

 private:
  /// An edge and its first node when the step began, as the energy reads it.
  struct Start {
    Eigen::Vector3d turn = Eigen::Vector3d::Zero();
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();  // of the tangents; zero where it is folded
    double length = 0.0;                               // [m]
  };

  double relaxation_time_;
  double share_ = 0.0;  // of a stiffness that resists what a step changes
  std::vector<Start> starts_;
};

}  // namespace fiber
