// The part that obstacles which move have in contacts: in the equations of a step, its energy, its
// impacts, and the forces on them.

#include <algorithm>
#include <cassert>

#include "src/sim/contact/contact_set.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Calls function(points, term, approach) for the terms of contacts with obstacles that are on
/// their way, with the part of that which is left, along the normal.
template <class Function>
void ContactSet::for_each_term_of_motion(const Rods& rods, const Function& function) const {
  DistanceTerms buffer;
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    const MovedShape* const shape = moved_->of_contact(i);
    if (shape != nullptr && !shape->stands_still()) {
      for_each_term(rods, i, buffer, [&](const ContactPoints& points, const DistanceTerm& term) {
        const Vector3d point = point_at(rods.positions, points.edge_a, points.s);
        function(points, term, shape->way_left(point).dot(term.normal));
      });
    }
  }
}

/// While obstacles are on their way, a step of Newton's method is that of the rods with them: the
/// forces by which contacts would change if the obstacle went on alone act on the rods.
void ContactSet::add_terms_of_motion(const Rods& rods) {
  for_each_term_of_motion(
      rods, [&](const ContactPoints& points, const DistanceTerm& term, double approach) {
        terms_[0].terms.push_back(
            {points, -term.curvature * approach * term.normal, Matrix3d::Zero(), 0.0, nullptr});
      });
}

void ContactSet::add_longest_ways(const Rods& rods, const std::vector<std::uint32_t>& islands,
                                  std::vector<double>& ways) const {
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    if (const MovedShape* const shape = moved_->of_contact(i)) {
      const ObstacleContact& contact = obstacle_contacts[i];
      double& way = ways[islands[contact.rod]];
      way = std::max(way, shape->way_left(rods.positions[contact.edge]).norm());
    }
  }
}

void ContactSet::add_resistances(const Rods& rods, const std::vector<std::uint32_t>& islands,
                                 std::vector<Resistance>& resistances) const {
  DistanceTerms buffer;
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    if (const MovedShape* const shape = moved_->of_contact(i)) {
      const double most = obstacle_contacts[i].barrier.max_driven_force();
      for_each_term(rods, i, buffer, [&](const ContactPoints& points, const DistanceTerm& term) {
        const Vector3d point = point_at(rods.positions, points.edge_a, points.s);
        const double approach = std::abs(shape->way(point).dot(term.normal));
        Resistance& resistance = resistances[islands[points.rod_a]];
        resistance.now -= term.slope * approach;
        resistance.most += most * approach;
      });
    }
  }
}

void ContactSet::add_motion_energies(const Rods& rods, const std::vector<Vector3d>& displacements,
                                     const std::vector<std::uint32_t>& islands,
                                     std::vector<MotionEnergy>& energies) const {
  for_each_term_of_motion(
      rods, [&](const ContactPoints& points, const DistanceTerm& term, double approach) {
        const Vector3d of_rod = point_at(displacements, points.edge_a, points.s);
        MotionEnergy& energy = energies[islands[points.rod_a]];
        energy.slope -= term.slope * approach;
        energy.square += term.curvature * approach * approach;
        energy.mixed += term.curvature * approach * of_rod.dot(term.normal);
      });
}

/// That of the obstacle where it touches, in the mean over the step; zero of one that stands still.
Vector3d ContactSet::obstacle_velocity(const Rods& rods, const ContactPoints& points) const {
  const MovedShape* const shape = has_motion_ ? moved_->of_object(points) : nullptr;
  if (shape == nullptr) {
    return Vector3d::Zero();
  }
  return shape->displacement(point_at(rods.positions, points.edge_a, points.s)) /
         shape->motion().elapsed;
}

/// Calls function(points, shape, point, force) for the forces of moving obstacles on rods.
template <class Function>
void ContactSet::for_each_obstacle_force(const Rods& rods, const Function& function) const {
  DistanceTerms buffer;
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    if (const MovedShape* const shape = moved_->of_contact(i)) {
      for_each_term(rods, i, buffer, [&](const ContactPoints& points, const DistanceTerm& term) {
        function(points, *shape, point_at(rods.positions, points.edge_a, points.s),
                 Vector3d(-term.slope * term.normal));
      });
    }
  }
  for (std::size_t i = distance_count(); i < contact_count(); ++i) {
    const ResistedPoint& resisted = resisted_point(i);
    if (const MovedShape* const shape = moved_->of_object(resisted.points)) {
      Vector3d point = point_at(rods.positions, resisted.points.edge_a, resisted.points.s);
      if (resisted.levers) {
        point += resisted.levers->front().arm;
      }
      function(resisted.points, *shape, point, resisted.force(rods, stick_length_));
    }
  }
}

void ContactSet::add_obstacle_work(const Rods& rods, const std::vector<std::uint32_t>& islands,
                                   std::vector<double>& work) const {
  for_each_obstacle_force(rods, [&](const ContactPoints& points, const MovedShape& shape,
                                    const Vector3d& point, const Vector3d& force) {
    work[islands[points.rod_a]] += force.dot(shape.displacement_in_solve(point));
  });
}

void ContactSet::add_obstacle_forces(const Rods& rods,
                                     std::vector<RodForces::ObstacleForce>& forces) const {
  if (!has_motion_ || forces.empty()) {
    return;
  }
  const auto act = [&](const ContactPoints& points, const Vector3d& point, const Vector3d& on_rod) {
    assert(points.rod_b >= forces.front().object);
    RodForces::ObstacleForce& force = forces[points.rod_b - forces.front().object];
    force.force -= on_rod;
    force.moment -= (point - force.point).cross(on_rod);
  };
  for_each_obstacle_force(
      rods, [&](const ContactPoints& points, const MovedShape& /*shape*/, const Vector3d& point,
                const Vector3d& force) { act(points, point, force); });
  for (const Impact& impact : impacts_) {
    if (moved_->of_object(impact.points) != nullptr) {
      const Vector3d point = point_at(rods.positions, impact.points.edge_a, impact.points.s);
      act(impact.points, point, impact.pressure / step_ * impact.normal);
      act(impact.points, impact.levers ? Vector3d(point + impact.levers->front().arm) : point,
          impact.friction / step_);
    }
  }
}

}  // namespace fiber
