// What contacts exert.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "src/sim/contact/contact_set-inl.hpp"

namespace fiber {

using Eigen::Vector3d;

void ContactSet::add_loads(std::vector<double>& loads) const {
  for (const std::vector<Term>& terms : terms_) {
    for (const Term& term : terms) {
      const PointPair& points = term.points;
      loads[points.rod_a] = std::max(loads[points.rod_a], term.load);
      if (points.edge_b != no_edge) {
        loads[points.rod_b] = std::max(loads[points.rod_b], term.load);
      }
    }
  }
}

void ContactSet::add_forces(const Rods& rods, std::vector<RodForces::ContactForce>& forces) const {
  using Key = std::array<std::uint32_t, 3>;
  std::map<Key, std::size_t> places;
  const auto force_of = [&](const PointPair& points) -> RodForces::ContactForce& {
    const auto [place, is_new] =
        places.emplace(Key{points.edge_a, points.rod_b, points.edge_b}, forces.size());
    if (is_new) {
      const bool is_obstacle = points.edge_b == no_edge;
      RodForces::ContactForce& force = forces.emplace_back();
      force.rod = points.rod_a;
      force.edge = points.edge_a - rods.first(points.rod_a);
      force.other_rod = is_obstacle ? RodForces::ContactForce::obstacle : points.rod_b;
      force.other_edge = is_obstacle ? 0 : points.edge_b - rods.first(points.rod_b);
      force.object = is_obstacle ? points.rod_b : 0;
      force.point = force.normal_force = force.friction_force = Vector3d::Zero();
    }
    return forces[place->second];
  };
  std::map<std::size_t, double> weights;
  for_each_distance(
      rods, [&](const PointPair& points, const DistanceTerm& term, const Barrier& /*barrier*/) {
        RodForces::ContactForce& force = force_of(points);
        const Vector3d on_a = point_at(rods.positions, points.edge_a, points.s);
        Vector3d between = on_a - rods.radii[points.rod_a] * term.normal;
        if (points.edge_b != no_edge) {
          const Vector3d on_b = point_at(rods.positions, points.edge_b, points.t);
          const double share =
              rods.radii[points.rod_a] / (rods.radii[points.rod_a] + rods.radii[points.rod_b]);
          between = on_a + share * (on_b - on_a);
        }
        force.normal_force -= term.slope * term.normal;
        force.point += std::abs(term.slope) * between;
        weights[static_cast<std::size_t>(&force - forces.data())] += std::abs(term.slope);
      });
  for (const auto& [place, weight] : weights) {
    forces[place].point /= weight;
  }
  for (const FrictionPoint& point : frictions_) {
    const Vector3d slip = slip_of(rods, point);
    RodForces::ContactForce& force = force_of(point.points);
    if (force.point.isZero(0.0)) {
      force.point = point_at(rods.positions, point.points.edge_a, point.points.s);
    }
    force.friction_force -=
        point.most * Friction::law(slip.norm(), stick_length_).resistance * slip;
  }
}

}  // namespace fiber
