#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// A rod as textbooks of position based dynamics have it, to compare with: a Cosserat rod of nodes
/// and of quaternions for its edges (Kugelstadt and Schömer 2016), whose constraints have the
/// compliances that the material gives them (XPBD, Macklin et al. 2016), in small steps (Macklin et
/// al. 2019) with one pass of Gauss–Seidel from the clamp to the tip.
///
/// Its first node is clamped: held, and joined to a quaternion that is held, too, over half an
/// edge.
class XpbdRod {
 public:
  /// @param points  [m] of a straight rod at equal distances
  /// @param inertia of cross-sections, in units of what they have: more of it, which is wrong, lets
  ///                Gauss–Seidel come to an end sooner
  XpbdRod(const std::vector<Eigen::Vector3d>& points, const RodSection& section,
          double inertia = 1.0);

  /// @param length       [s]
  /// @param acceleration [m/s²]
  void step(double length, const Eigen::Vector3d& acceleration);

  /// Multiplies all velocities.
  void damp(double factor);

  const std::vector<Eigen::Vector3d>& positions() const { return positions_; }

 private:
  void predict(double length, const Eigen::Vector3d& acceleration);
  void project_stretch(std::size_t edge, double step);
  void project_bend(std::size_t node, double step);
  void find_velocities(double length);

  RodSection section_;
  double edge_length_;                            // [m]
  double turn_weight_;                            // of a quaternion, an inverse mass [1/(kg m²)]
  std::vector<Eigen::Vector3d> positions_;        // [m]
  std::vector<Eigen::Vector3d> velocities_;       // [m/s]
  std::vector<double> weights_;                   // inverse masses, 0 of what is held [1/kg]
  std::vector<Eigen::Quaterniond> frames_;        // the clamp's, then one by edge
  std::vector<Eigen::Vector3d> spins_;            // [rad/s]
  std::vector<Eigen::Vector3d> start_positions_;  // of the step
  std::vector<Eigen::Quaterniond> start_frames_;
  std::vector<Eigen::Vector3d> stretch_multipliers_;  // of edges
  std::vector<Eigen::Vector3d> bend_multipliers_;     // of nodes
};

}  // namespace fiber
