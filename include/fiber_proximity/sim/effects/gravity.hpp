#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// The same acceleration everywhere.
class Gravity : public Effect {
 public:
  /// @param acceleration [m/s²]
  /// @throws std::invalid_argument if it is not finite
  explicit Gravity(const Eigen::Vector3d& acceleration);

  double energy(const Rods& rods, std::uint32_t rod) const override;
  void add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const override;

  bool works_in_lanes(const Rods& /*rods*/) const override { return true; }
  void energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                       Lanes& energy) const override;
  void add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& values,
                                LaneSystem& system) const override;

 private:
  Eigen::Vector3d acceleration_;
};

}  // namespace fiber
