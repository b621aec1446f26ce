#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/sim/material.hpp"

namespace fiber {

/// Rods as a simulation moves them: chains of nodes with masses, straight edges between them.
///
/// Rod r owns the nodes offsets[r] .. offsets[r+1]-1 of all arrays, as in FiberAssembly; an edge
/// has the index of its first node. Arrays that only one effect needs are empty without that
/// effect.
struct Rods {
  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii;         ///< by rod [m]
  std::vector<RodSection> sections;  ///< by rod

  std::vector<Eigen::Vector3d> positions;   ///< [m]
  std::vector<Eigen::Vector3d> velocities;  ///< [m/s]
  std::vector<double> masses;               ///< [kg]
  std::vector<double> rest_lengths;         ///< of edges, 0 at each rod's last node [m]

  std::vector<double> natural_curvatures;  ///< of nodes [1/m]; empty: all are 0

  /// With twist only, and in place of these if not empty: how the rod bends at rest, along the
  /// material directions of its cross-sections (material curvatures of Bergou et al. 2008, Sect.
  /// 4.2), of nodes [1/m]. At an end it is against a clamp. natural_curvature.hpp makes them.
  std::vector<Eigen::Vector2d> natural_curvature_vectors;

  /// With twist only, by edge: a unit vector across the edge that follows it without turning about
  /// it, as it was when the step began, and the tangent then.
  std::vector<Eigen::Vector3d> directors;
  std::vector<Eigen::Vector3d> start_tangents;
  std::vector<double> angles;  ///< of the cross-section against the director [rad]
  std::vector<double> spins;   ///< their rates [rad/s]

  std::uint32_t count() const { return static_cast<std::uint32_t>(radii.size()); }
  std::uint32_t first(std::uint32_t rod) const { return offsets[rod]; }
  std::uint32_t end(std::uint32_t rod) const { return offsets[rod + 1]; }
  std::uint32_t node_count(std::uint32_t rod) const { return end(rod) - first(rod); }

  /// Length at rest that belongs to an inner node: half of each of its edges [m].
  double rest_length_at(std::uint32_t node) const {
    return 0.5 * (rest_lengths[node - 1] + rest_lengths[node]);
  }

  /// Adds a rod that is at rest and neither stretched nor compressed.
  /// @param points [m] at least two
  /// @param radius [m]
  /// @throws std::invalid_argument naming rod, point or edge, and value, for fewer points, points
  ///         that are not finite, edges without length, a radius that is not positive, a section
  ///         that does not validate; nothing is added then
  void add(const std::vector<Eigen::Vector3d>& points, double radius, const RodSection& section);
};

}  // namespace fiber
