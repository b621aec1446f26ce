#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// Wind: a mean velocity and a gust that swells and ebbs as it passes. No random numbers, so that
/// the same scene gives the same motion.
struct WindField {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d gust = Eigen::Vector3d::Zero();  ///< amplitude [m/s]
  double gust_period = 1.0;                        ///< [s]
  double gust_length = 1.0;                        ///< along the mean velocity [m]

  Eigen::Vector3d at(const Eigen::Vector3d& point, double time) const;
};

/// Resistance of a fluid to slender rods: ½ ρ d c |w| w per length, with the diameter d and the
/// velocity w of the fluid against the rod, across and along the rod with coefficients of their own
/// (Taylor 1952). The coefficients' product with |w| is that of the step's beginning.
class Drag : public Effect {
 public:
  /// What flows past the rods, and how much they resist it.
  struct Options {
    double fluid_density = 1.2;  ///< [kg/m³]
    double across = 1.2;         ///< coefficient of a cylinder in cross flow
    double along = 0.02;         ///< and along its axis
    WindField wind;
  };

  /// @throws std::invalid_argument naming the value for negative or infinite ones, or a gust whose
  ///         period or length is not positive
  explicit Drag(const Options& options);

  void begin_step(Rods& rods, const TimeStep& step) override;
  bool is_stored() const override { return false; }
  std::uint32_t values_per_node() const override { return 8; }
  const double* values_of(std::uint32_t node) const override;
  void energy(const RodPack& rods, const std::vector<SimdBatch>& values,
              SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& values,
                       PackSystem& system) const override;

 private:
  /// What resists the motion of a node in a step, as the energy reads it.
  struct Node {
    Eigen::Vector3d tangent;
    Eigen::Vector3d carried;  // where the wind alone would bring it [m]
    double across;            // force by distance from there [N/m]
    double along;
  };

  Node node_at(const Rods& rods, std::uint32_t rod, std::uint32_t node, const TimeStep& step) const;

  Options options_;
  std::vector<Node> nodes_;
};

}  // namespace fiber
