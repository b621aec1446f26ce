#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// The same acceleration everywhere.
class Gravity : public Effect {
 public:
  /// @param acceleration [m/s²]
  /// @throws std::invalid_argument if it is not finite
  explicit Gravity(const Eigen::Vector3d& acceleration);

  void energy(const RodPack& rods, const std::vector<SimdBatch>& values,
              SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& values,
                       PackSystem& system) const override;

 private:
  Eigen::Vector3d acceleration_;
};

}  // namespace fiber
