// The work that contacts do in a step beyond what they give back of their energy, and the forces
// without it.

#include <algorithm>

#include "src/sim/contact/contact_set.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The work that a point of a contact has done too much.
struct ExcessWork {
  double work;     // [J]
  Vector3d moved;  // by how much the sides have moved against each other
  bool leads_round;
};

}  // namespace

/// Calls function(contact, points, excess) for all points that press and do such work. By the
/// distances d of the same two points before and after, a force p along the normal n has done
/// p n·Δx where it has given back p Δd; as d is convex, that is no less.
template <class Function>
void ContactSet::for_each_excess_work(const Rods& rods, const Function& function) const {
  DistanceTerms buffer;
  for (std::size_t i = 0; i < distance_count(); ++i) {
    const auto distance_at = [&](const Vector3d& place) -> PointDistance {
      if (i < obstacle_contacts.size()) {
        return obstacle_contacts[i].piece.distance_from(place);
      }
      return {place.norm(), place.normalized()};
    };
    const auto judge = [&](const ContactPoints& points, const DistanceTerm& term) {
      if (!(term.pressure > 0.0)) {
        return;
      }
      const Vector3d now = difference_of_points(rods.positions, points);
      const Vector3d moved = now - difference_of_points(origins_.state->positions, points) -
                             step_ * obstacle_velocity(rods, points);
      const PointDistance before = distance_at(now - moved);
      const double work =
          term.pressure * (term.normal.dot(moved) - distance_at(now).distance + before.distance);
      if (work > 0.0) {
        function(i, points, ExcessWork{work, moved, before.gradient.dot(term.normal) < 0.0});
      }
    };
    if (energies_[i] > 0.0) {
      for_each_term(rods, i, buffer, judge);
    }
  }
}

void ContactSet::add_excess_work(const Rods& rods, const std::vector<std::uint32_t>& islands,
                                 std::vector<double>& work) const {
  for_each_excess_work(
      rods, [&](std::size_t /*contact*/, const ContactPoints& points, const ExcessWork& excess) {
        work[islands[points.rod_a]] += excess.work;
      });
}

void ContactSet::add_slip_energies(const Rods& rods, const std::vector<std::uint32_t>& islands,
                                   std::vector<double>& energies) const {
  for (const ResistedPoint& point : frictions_) {
    double& energy = energies[islands[point.points.rod_a]];
    if (energy > 0.0) {
      energy += point.stored_energy(point.slip(rods).norm(), stick_length_);
    }
  }
}

void ContactSet::use_midpoint_normals(const Rods& rods, const std::vector<std::uint32_t>& islands,
                                      const std::vector<bool>& which,
                                      std::vector<std::uint32_t>& count) {
  midpoint_forces_.erase(std::remove_if(midpoint_forces_.begin(), midpoint_forces_.end(),
                                        [&](const ResistedPoint& point) {
                                          return which[islands[point.points.rod_a]];
                                        }),
                         midpoint_forces_.end());
  for_each_excess_work(
      rods, [&](std::size_t contact, const ContactPoints& points, const ExcessWork& excess) {
        const std::uint32_t island = islands[points.rod_a];
        if (which[island] && !excess.leads_round) {
          const Vector3d now = difference_of_points(rods.positions, points);
          midpoint_forces_.push_back({contact, points, Vector3d::Zero(), 0.0, now - excess.moved,
                                      std::nullopt, excess.work / excess.moved.squaredNorm()});
          ++count[island];
        }
      });
  evaluate_energies(rods, distance_count());
}

}  // namespace fiber
