#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace fiber {

/// The minimal enclosing sphere of points and the at most four of them that define it.
struct MinimalSphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< [m]
  double squared_radius = -1.0;                      ///< [m²]; negative: of no points

  std::array<std::uint32_t, 4> basis{};  ///< indices of the defining points
  std::uint32_t basis_size = 0;
};

/// Welzl's algorithm in its iterative move-to-front form, without recursion over the points. Its
/// time is linear only where points come in no order of theirs (points along a line are quadratic),
/// so it shuffles them first, always the same way: the same points give the same sphere.
/// @param order indices of the points to enclose; reordered, defining points first
MinimalSphere minimal_sphere(const std::vector<Eigen::Vector3d>& points,
                             std::vector<std::uint32_t>& order);

}  // namespace fiber
