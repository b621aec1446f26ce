#include "src/sim/natural_curvature.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "fiber_proximity/sim/edge_turn.hpp"
#include "fiber_proximity/sim/effects/twist.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "src/sim/require.hpp"

namespace fiber {

using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

/// By how much and to which side a rod bends at a node.
struct Turn {
  double angle;
  Vector3d side;  ///< across the edge before, of unit length; zero if it does not bend
};

Turn turn_at(const Rods& rods, std::uint32_t node) {
  const EdgeTurn pair(rods, node);
  const Vector3d& a = pair.before().tangent;
  const Vector3d& b = pair.after().tangent;
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
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      const Turn turn = turn_at(rods, i);
      const double curvature = turn.angle / rods.rest_length_at(i);
      if (has_twist) {
        rods.natural_curvature_vectors[i] =
            curvature * by_material(cross_section(rods, i - 1), turn.side);
      } else {
        rods.natural_curvatures[i] = curvature;
      }
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
