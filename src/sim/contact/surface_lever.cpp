#include "src/sim/contact/surface_lever.hpp"

#include "src/sim/edges.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

SurfaceLever::Jacobian SurfaceLever::jacobian(double parameter) const {
  const Vector3d by_turn = tangent.cross(arm);
  const Matrix3d by_change =
      inverse_length * (tangent.dot(arm) * Matrix3d::Identity() - tangent * arm.transpose()) +
      by_turn * carried_turn.transpose();
  Jacobian jacobian;
  jacobian << (1.0 - parameter) * Matrix3d::Identity() - by_change, by_turn,
      parameter * Matrix3d::Identity() + by_change;
  return jacobian;
}

std::optional<SurfaceLevers> surface_levers(const Rods& rods, const ContactPoints& points,
                                            const Vector3d& normal) {
  if (rods.angles.empty()) {
    return std::nullopt;
  }
  const auto lever = [&](std::uint32_t edge, const Vector3d& arm) -> SurfaceLever {
    const EdgeDirection direction = edge_direction(rods, edge);
    return {arm, direction.tangent, 1.0 / direction.length,
            director_turn(rods.start_tangents[edge], direction)};
  };
  const double radius = rods.edge_radius(points.rod_a, points.edge_a);
  const Vector3d zero = Vector3d::Zero();
  if (!points.is_of_rods()) {
    return SurfaceLevers{lever(points.edge_a, -radius * normal),
                         SurfaceLever{zero, zero, 0.0, zero}};
  }
  const double other_radius = rods.edge_radius(points.rod_b, points.edge_b);
  const double distance = normal.dot(difference_of_points(rods.positions, points));
  const double share = distance / (radius + other_radius);
  return SurfaceLevers{lever(points.edge_a, -share * radius * normal),
                       lever(points.edge_b, share * other_radius * normal)};
}

Vector3d lever_motion(const SurfaceLevers& levers, const ContactPoints& points,
                      const std::vector<Vector3d>& nodes, const std::vector<double>& sections) {
  const auto of = [&](const SurfaceLever& lever, std::uint32_t edge) {
    return lever.motion(nodes[edge + 1] - nodes[edge], sections[edge]);
  };
  Vector3d motion = of(levers[0], points.edge_a);
  if (points.is_of_rods()) {
    motion -= of(levers[1], points.edge_b);
  }
  return motion;
}

}  // namespace fiber
