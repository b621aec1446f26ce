// Cross-sections of rods with twist: their material directions, how they turn with the unknowns,
// and energies of what two of them differ by.
#pragma once

#include <cmath>
#include <stdexcept>
#include <string>

#include "src/sim/edges.hpp"

namespace fiber {

/// The tangent and the two material directions of a cross-section of a rod, or of a clamp.
struct CrossSection {
  /// @param director across the tangent, of unit length
  /// @param angle    of the first material direction against it [rad]
  CrossSection(const Eigen::Vector3d& tangent_there, const Eigen::Vector3d& director, double angle)
      : tangent(tangent_there) {
    const Eigen::Vector3d across = tangent.cross(director);
    const double cosine = std::cos(angle);
    const double sine = std::sin(angle);
    first = cosine * director + sine * across;
    second = cosine * across - sine * director;
  }

  Eigen::Vector3d tangent;
  Eigen::Vector3d first;
  Eigen::Vector3d second;  ///< tangent x first
};

/// Derivative by the unknowns of an edge: its first node, its angle, its second node.
using RotationByEdge = Eigen::Matrix<double, 3, 7>;

/// The matrix of the cross product with a vector on the left.
inline Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

inline CrossSection cross_section(const PackLane& rod, std::uint32_t edge) {
  return {rod.direction(edge).tangent, rod.director(edge), rod.angle(edge)};
}

inline CrossSection cross_section(const Rods& rods, std::uint32_t edge) {
  return {edge_direction(rods, edge).tangent, current_director(rods, edge), rods.angles[edge]};
}

/// That of a state.
/// @param rods their directors and tangents are those with which the step began
inline CrossSection cross_section(const Rods& rods, const RodState& state, std::uint32_t edge) {
  const Eigen::Vector3d tangent = edge_direction(state, edge).tangent;
  return {tangent, transport(rods.directors[edge], rods.start_tangents[edge], tangent),
          state.angles[edge]};
}

inline Eigen::Vector2d by_material(const CrossSection& section, const Eigen::Vector3d& v) {
  return {section.first.dot(v), section.second.dot(v)};
}

/// A side of a rod with twist, as its first cross-section has it now: of unit length, by the
/// material directions.
/// @param towards to which side of its first edge; of any length
/// @throws std::invalid_argument for a direction that is not finite or along that edge
inline Eigen::Vector2d side_towards(const Rods& rods, std::uint32_t rod,
                                    const Eigen::Vector3d& towards) {
  const Eigen::Vector2d side = by_material(cross_section(rods, rods.first(rod)), towards);
  if (!(towards.allFinite() && side.norm() > 1e-6 * towards.norm())) {
    throw std::invalid_argument("the side must be finite and not along the first edge of rod " +
                                std::to_string(rod));
  }
  return side.normalized();
}

/// The derivative of the rotation of an edge's cross-section by the unknowns of the edge.
inline RotationByEdge rotation_by_edge(const PackLane& rod, std::uint32_t edge) {
  const EdgeDirection direction = rod.direction(edge);
  const Eigen::Matrix3d by_second =
      cross_matrix(direction.tangent) / direction.length +
      direction.tangent * director_turn(rod.start_tangent(edge), direction).transpose();
  RotationByEdge rotation;
  rotation << -by_second, direction.tangent, by_second;
  return rotation;
}

/// Adds the derivatives of half the square of a residual.
/// @param by_all derivative of the residual by all unknowns from the first node on
template <class Residual, class ByAll>
void add_square(std::uint32_t first_node, double stiffness, const Residual& residual,
                const ByAll& by_all, RodSystem& system) {
  const Eigen::Index count = by_all.cols();
  for (Eigen::Index c = 0; c < count; c += 4) {
    const auto node = first_node + static_cast<std::uint32_t>(c / 4);
    const Eigen::Vector3d gradient = by_all.template middleCols<3>(c).transpose() * residual;
    system.add_gradient(node, stiffness * gradient);
    if (c + 3 < count) {
      system.add_angle_gradient(node, stiffness * by_all.col(c + 3).dot(residual));
    }
  }
  const std::size_t start = std::size_t{first_node} * system.unknowns();
  for (Eigen::Index c = 0; c < count; ++c) {
    for (Eigen::Index r = c; r < count; ++r) {
      system.add_hessian_entry(start + r, start + c, stiffness * by_all.col(r).dot(by_all.col(c)));
    }
  }
}

}  // namespace fiber
