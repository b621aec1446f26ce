#include "src/sim/contact/add_obstacle_contacts.hpp"

#include <functional>

namespace fiber {

using Eigen::Vector3d;

void add_obstacle_contacts(const ObstacleShape& shape, const Rods& rods, std::uint32_t rod,
                           std::uint32_t edge, const EdgePart& part,
                           const EnvironmentContact::Options& options, double within,
                           std::vector<ObstacleContact>& found) {
  const double radius = part.is_point() ? rods.node_radius(rod, part.first == 0.0 ? edge : edge + 1)
                                        : rods.edge_radius(rod, edge);
  const double stiffness = options.stiffness > 0.0
                               ? options.stiffness
                               : material_contact_stiffness(rods.sections[rod], radius);
  const Barrier barrier = Barrier::around(radius, stiffness);
  const Vector3d& p0 = rods.positions[part.first == 1.0 ? edge + 1 : edge];
  const Vector3d& p1 = part.is_point() ? p0 : rods.positions[edge + 1];
  const auto add = [&](const ObstaclePiece& piece, const EdgePart& of_edge,
                       std::optional<double> point) {
    found.push_back({rod, edge, of_edge, point, barrier, options.restitution, piece});
  };
  const auto add_piece = [&](const ObstaclePiece& piece) {
    if (part.is_point()) {
      add(piece, part, 0.0);
      return;
    }
    const std::optional<double> middle = piece.middle_of_flat(p0, p1);
    if (middle && piece.distance_from((1.0 - *middle) * p0 + *middle * p1).distance <= within) {
      add(piece, part, middle);
      add(piece, {0.0, *middle}, std::nullopt);
      add(piece, {*middle, 1.0}, std::nullopt);
    } else {
      add(piece, part, std::nullopt);
    }
  };
  if (shape.is_convex()) {
    add_piece(ObstaclePiece(shape, {}));
  } else {
    visit_near_pieces(shape, p0, p1, within, std::cref(add_piece));
  }
}

}  // namespace fiber
