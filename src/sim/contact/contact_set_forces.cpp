// The forces of contacts, as they are told.

#include <array>
#include <cmath>
#include <map>

#include "src/sim/contact/contact_set.hpp"

namespace fiber {

using Eigen::Vector3d;

void ContactSet::add_forces(const Rods& rods, std::vector<RodForces::ContactForce>& forces) const {
  using Key = std::array<std::uint32_t, 3>;
  std::map<Key, std::size_t> places;
  const auto force_of = [&](const ContactPoints& points) -> RodForces::ContactForce& {
    const auto [place, is_new] =
        places.emplace(Key{points.edge_a, points.rod_b, points.edge_b}, forces.size());
    if (is_new) {
      const bool is_obstacle = !points.is_of_rods();
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
  const auto press = [&](const ContactPoints& points, const DistanceTerm& term) {
    RodForces::ContactForce& force = force_of(points);
    const Vector3d on_a = point_at(rods.positions, points.edge_a, points.s);
    const double radius_a = rods.edge_radius(points.rod_a, points.edge_a);
    Vector3d between = on_a - radius_a * term.normal;
    if (points.is_of_rods()) {
      const Vector3d on_b = point_at(rods.positions, points.edge_b, points.t);
      const double share = radius_a / (radius_a + rods.edge_radius(points.rod_b, points.edge_b));
      between = on_a + share * (on_b - on_a);
    }
    force.normal_force -= term.slope * term.normal;
    force.point += std::abs(term.slope) * between;
    weights[static_cast<std::size_t>(&force - forces.data())] += std::abs(term.slope);
  };
  DistanceTerms buffer;
  for (std::size_t i = 0; i < distance_count(); ++i) {
    for_each_term(rods, i, buffer, press);
  }
  for (const auto& [place, weight] : weights) {
    forces[place].point /= weight;
  }
  for (const Impact& impact : impacts_) {
    RodForces::ContactForce& force = force_of(impact.points);
    force.normal_force += impact.pressure / step_ * impact.normal;
    force.friction_force += impact.friction / step_;
  }
  const auto resist = [&](const ResistedPoint& point,
                          Vector3d RodForces::ContactForce::*component) {
    RodForces::ContactForce& force = force_of(point.points);
    if (force.point.isZero(0.0)) {
      force.point = point_at(rods.positions, point.points.edge_a, point.points.s);
    }
    force.*component += point.force(rods, stick_length_);
  };
  for (const ResistedPoint& point : frictions_) {
    resist(point, &RodForces::ContactForce::friction_force);
  }
  for (const ResistedPoint& point : midpoint_forces_) {
    resist(point, &RodForces::ContactForce::normal_force);
  }
}

}  // namespace fiber
