#include "src/sim/effects/natural_bend.hpp"

#include <algorithm>
#include <cmath>

#include "src/sim/require.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// Derivative by the unknowns of an edge: its first node, its angle, its second node.
using RotationByEdge = Eigen::Matrix<double, 3, 7>;

/// The matrix of the cross product with a vector on the left.
Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

CrossSection cross_section(const PackLane& rod, std::uint32_t edge) {
  return {rod.direction(edge).tangent, rod.director(edge), rod.angle(edge)};
}

/// The derivative of the rotation of an edge's cross-section by the unknowns of the edge.
RotationByEdge rotation_by_edge(const PackLane& rod, std::uint32_t edge) {
  const EdgeDirection direction = rod.direction(edge);
  const Matrix3d by_second =
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
    const Vector3d gradient = by_all.template middleCols<3>(c).transpose() * residual;
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

}  // namespace

CrossSection::CrossSection(const Vector3d& tangent_there, const Vector3d& director, double angle)
    : tangent(tangent_there) {
  const Vector3d across = tangent.cross(director);
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  first = cosine * director + sine * across;
  second = cosine * across - sine * director;
}

NaturalBend::NaturalBend(const PackLane& rod, std::uint32_t node, const Vector2d& curvature,
                         double length, const CrossSection& before, const CrossSection& after)
    : rod_(rod),
      node_(node),
      stiffness_(rod.bending_stiffness(node) / length),
      before_(before.tangent),
      after_(after.tangent) {
  const double size = curvature.norm();
  const double angle = std::min(size * length, M_PI);
  const Vector2d side =
      size > 0.0 ? Vector2d(std::sin(angle) / size * curvature) : Vector2d::Zero();
  natural_after_ = std::cos(angle) * before_ + side.x() * before.first + side.y() * before.second;
  natural_before_ = std::cos(angle) * after_ - side.x() * after.first - side.y() * after.second;
  // A fold has no side: there, nothing but rounding errors would be left.
  constexpr double min_cosine = 1e-6;
  weight_ = 0.5 / std::max(min_cosine, std::cos(0.5 * angle));
  residual_ = weight_ * (after_ - natural_after_ + natural_before_ - before_);
}

NaturalBend NaturalBend::at_node(const PackLane& rod, std::uint32_t node,
                                 const Vector2d& curvature) {
  const double length = 0.5 * (rod.rest_length(node - 1) + rod.rest_length(node));
  return {rod, node, curvature, length, cross_section(rod, node - 1), cross_section(rod, node)};
}

NaturalBend NaturalBend::at_clamp(const PackLane& rod, std::uint32_t node,
                                  const Vector2d& curvature, const CrossSection& clamp) {
  const std::uint32_t edge = node == 0 ? 0 : node - 1;
  const double length = 0.5 * rod.rest_length(edge);
  const CrossSection end = cross_section(rod, edge);
  return {rod, node, curvature, length, node == 0 ? clamp : end, node == 0 ? end : clamp};
}

Vector3d NaturalBend::moment() const {
  return stiffness_ * weight_ * 0.5 *
         ((before_ + natural_after_).cross(residual_) +
          (after_ + natural_before_).cross(residual_));
}

void NaturalBend::add_derivatives(RodSystem& system) const {
  const bool has_before = node_ > 0;
  const bool has_after = node_ + 1 < rod_.node_count();
  // The derivative of the residual by all unknowns of the one or two edges.
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 11> by_all;
  by_all.setZero(3, has_before && has_after ? 11 : 7);
  if (has_before) {
    by_all.leftCols<7>() +=
        weight_ * cross_matrix(before_ + natural_after_) * rotation_by_edge(rod_, node_ - 1);
  }
  if (has_after) {
    by_all.rightCols<7>() -=
        weight_ * cross_matrix(after_ + natural_before_) * rotation_by_edge(rod_, node_);
  }
  add_square(has_before ? node_ - 1 : node_, stiffness_, residual_, by_all, system);
}

namespace {

/// The angle and the side to which a rod bends from one edge to the next.
struct Turn {
  double angle;
  Vector3d side;  ///< across the edge before, of unit length; zero if it does not bend
};

Turn turn_between(const Rods& rods, std::uint32_t edge, std::uint32_t next) {
  const Vector3d a = edge_direction(rods, edge).tangent;
  const Vector3d b = edge_direction(rods, next).tangent;
  const double cosine = a.dot(b);
  const Vector3d across = b - cosine * a;
  const bool has_side = across.norm() > 0.0;
  // A fold is there whatever its side.
  const Vector3d any = cosine < 0.0 ? a.unitOrthogonal() : Vector3d::Zero();
  return {std::atan2(across.norm(), cosine), has_side ? across.normalized() : any};
}

CrossSection cross_section(const Rods& rods, std::uint32_t edge) {
  return {edge_direction(rods, edge).tangent, current_director(rods, edge), rods.angles[edge]};
}

Vector2d by_material(const CrossSection& section, const Vector3d& v) {
  return {section.first.dot(v), section.second.dot(v)};
}

}  // namespace

void set_natural_shape(Rods& rods) {
  const bool has_twist = !rods.directors.empty();
  if (has_twist) {
    rods.natural_curvature_vectors.assign(rods.positions.size(), Vector2d::Zero());
  } else {
    rods.natural_curvatures.assign(rods.positions.size(), 0.0);
  }
  const auto set = [&](std::uint32_t node, std::uint32_t edge, std::uint32_t next, double length) {
    const Turn turn = turn_between(rods, edge, next);
    const double curvature = turn.angle / length;
    if (has_twist) {
      rods.natural_curvature_vectors[node] =
          curvature * by_material(cross_section(rods, edge), turn.side);
    } else {
      rods.natural_curvatures[node] = curvature;
    }
  };
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const std::uint32_t first = rods.first(rod);
    const std::uint32_t last = rods.end(rod) - 1;
    for (std::uint32_t i = first + 1; i < last; ++i) {
      set(i, i - 1, i, rods.rest_length_at(i));
    }
    if (rods.is_closed(rod)) {
      set(first, last - 1, first, rods.rest_length_at_seam(rod));
      set(last, last - 1, first, rods.rest_length_at_seam(rod));
    }
  }
}

void set_natural_arc(Rods& rods, std::uint32_t rod, double curvature, const Vector3d& towards) {
  if (rods.directors.empty()) {
    throw std::invalid_argument("natural curvature: it has no side without twist");
  }
  require_not_negative("natural curvature: it", curvature, " 1/m");
  const CrossSection section = cross_section(rods, rods.first(rod));
  const Vector2d side = by_material(section, towards);
  if (!(towards.allFinite() && side.norm() > 1e-6 * towards.norm())) {
    throw std::invalid_argument(
        "natural curvature: the side must be finite and not along the "
        "first edge of rod " +
        std::to_string(rod));
  }
  rods.natural_curvature_vectors.resize(rods.positions.size(), Vector2d::Zero());
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    rods.natural_curvature_vectors[i] = curvature * side.normalized();
  }
}

}  // namespace fiber
