#include "src/sim/effects/natural_bend.hpp"

#include <algorithm>
#include <cmath>

#include "src/sim/require.hpp"
#include "src/text/with_context.hpp"

namespace fiber {

using Eigen::Vector2d;
using Eigen::Vector3d;

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
  const Vector2d side =
      with_context("natural curvature", [&] { return side_towards(rods, rod, towards); });
  rods.natural_curvature_vectors.resize(rods.positions.size(), Vector2d::Zero());
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    rods.natural_curvature_vectors[i] = curvature * side;
  }
}

}  // namespace fiber
