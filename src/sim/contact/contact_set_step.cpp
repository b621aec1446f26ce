// How far contacts let a step of Newton's method go, and which impacts it ends with.

#include <algorithm>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/environment/convex_solids.hpp"
#include "src/environment/shape_contact_time.hpp"
#include "src/sim/contact/contact_set.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The part of its excess over the least distance that a distance may lose in a step; and the
/// tolerance of the time of that, in parts of the excess that is left.
constexpr double max_loss = 0.8;
constexpr double tolerance = 0.1;

/// The square of the largest approach of two edges' nodes.
double squared_approach(const Vector3d* a, const Vector3d* b) {
  return std::max(std::max((a[0] - b[0]).squaredNorm(), (a[0] - b[1]).squaredNorm()),
                  std::max((a[1] - b[0]).squaredNorm(), (a[1] - b[1]).squaredNorm()));
}

/// Shortens a share of a step so that an edge does not reach an obstacle. It need not be shortened
/// for an edge that moves less than its distance, or for one that stays in front of the plane
/// between it and a convex obstacle. All others are bounded by the time of contact.
double bounded_share(const Rods& rods, const ObstacleEdge& edge,
                     const std::vector<Vector3d>& displacements, double share) {
  const Vector3d* const now = &rods.positions[edge.edge];
  const Vector3d* const step = &displacements[edge.edge];
  double farthest = 0.0;  // from where the ends were
  double lowest = edge.distance;
  for (std::size_t i = 0; i < 2; ++i) {
    farthest = std::max({farthest, (now[i] - edge.starts[i]).norm(),
                         (now[i] + share * step[i] - edge.starts[i]).norm()});
    lowest = std::min(lowest, edge.normal.dot(now[i] + share * step[i] - edge.point));
  }
  const double left = (1.0 - max_loss) * edge.distance;
  if (farthest <= max_loss * edge.distance || (edge.shape->is_convex() && lowest >= left)) {
    return share;
  }
  const Shape& shape = *edge.shape->shape;
  AxisMotion motion;
  for (std::size_t i = 0; i < 2; ++i) {
    motion.before[i] = edge.shape->to_shape * now[i];
    motion.after[i] = edge.shape->to_shape * (now[i] + share * step[i]);
  }
  const AxisDistance nearest =
      axis_distance(shape, motion.before[0], motion.before[1], 2.0 * (edge.distance + farthest));
  const double gap = std::max(0.0, nearest.lower);
  const double error = 0x1p-48 * (reach(shape) + edge.shape->pose.translation().norm() +
                                  now[0].norm() + now[1].norm());
  const ContactTime time = contact_time(shape, motion, {(1.0 - max_loss) * gap, error},
                                        tolerance * (1.0 - max_loss) * gap);
  return time.hit ? share * time.lower : share;
}

}  // namespace

double ContactSet::restitution_of(std::size_t contact) const {
  return contact < obstacle_contacts.size() ? obstacle_contacts[contact].restitution
                                            : pairs[contact - obstacle_contacts.size()].restitution;
}

std::vector<Impact> ContactSet::find_impacts(const Rods& rods,
                                             const std::vector<bool>& is_returning) const {
  std::vector<Impact> found;
  const auto may_return = [&](std::size_t contact) {
    const auto [a, b] = rods_of(contact);
    return was_near_[contact] && (is_returning[a] || is_returning[b]);
  };
  // In most steps no contact begins or returns anything, and none need be looked at more closely.
  bool is_any_of_impact = false;
  for (std::size_t i = 0; i < distance_count() && !is_any_of_impact; ++i) {
    is_any_of_impact = energies_[i] > 0.0 && (!was_near_[i] || may_return(i));
  }
  if (!is_any_of_impact) {
    return found;
  }
  is_any_of_impact = false;
  std::vector<Vector3d> frictions(distance_count(), Vector3d::Zero());  // on a [N]
  for (const ResistedPoint& point : frictions_) {
    frictions[point.contact] += point.force(rods, stick_length_);
  }
  DistanceTerms buffer;
  for (std::size_t i = 0; i < distance_count(); ++i) {
    if (energies_[i] == 0.0) {
      continue;
    }
    // A contact may give back what its points press with. Slopes are more where others pull: two
    // edges beside the node between them share what it would press with.
    double pressure = 0.0;  // of all points [N]
    if (may_return(i)) {
      for_each_term(rods, i, buffer,
                    [&](const ContactPoints& /*points*/, const DistanceTerm& term) {
                      pressure += std::max(0.0, term.pressure);
                    });
    }
    for_each_term(rods, i, buffer, [&](const ContactPoints& points, const DistanceTerm& term) {
      if (!(term.pressure > 0.0)) {
        return;
      }
      const Vector3d of_obstacle = obstacle_velocity(rods, points);
      const double approach =
          (of_obstacle - difference_of_points(rods.velocities, points)).dot(term.normal);
      Impact impact{points, term.normal, surface_levers(rods, points, term.normal)};
      impact.obstacle_velocity = of_obstacle;
      impact.has_begun = !was_near_[i] && approach > Impact::min_speed;
      if (impact.has_begun) {
        impact.separation = restitution_of(i) * approach;
      } else if (may_return(i)) {
        impact.returnable = step_ * term.pressure;
        impact.step_friction = impact.returnable / pressure * frictions[i];
        impact.max_separation = std::max(0.0, -approach);
      }
      is_any_of_impact |= impact.has_begun || impact.returnable > 0.0;
      found.push_back(impact);
    });
  }
  return is_any_of_impact ? found : std::vector<Impact>{};
}

void ContactSet::bound_step(const Rods& rods, const std::vector<Vector3d>& displacements,
                            const std::vector<std::uint32_t>& islands, std::vector<double>& shares,
                            std::vector<Vector3d>& ends) const {
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    double& share = shares[islands[obstacle_contacts[i].rod]];
    const MovedShape* const moved = has_motion_ ? moved_->of_contact(i) : nullptr;
    if (moved != nullptr && !moved->stands_still()) {
      share = bounded_share(obstacle_contacts[i], obstacle_distances_[i], *moved, rods.positions,
                            displacements, max_loss, share);
      continue;
    }
    share = bounded_share(obstacle_contacts[i], obstacle_distances_[i], rods.positions,
                          displacements, max_loss, share);
  }
  for (std::size_t i = 0; i < obstacle_edges.size(); ++i) {
    const ObstacleEdge& edge = obstacle_edges[i];
    double& share = shares[islands[edge.rod]];
    const MovedShape* const moved = has_motion_ ? moved_->of_edge(i) : nullptr;
    share = moved != nullptr
                ? bounded_share(edge.edge, *moved, rods.positions, displacements, max_loss, share)
                : bounded_share(rods, edge, displacements, share);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const EdgePair& pair = pairs[i];
    double& share = shares[islands[pair.rod_a]];
    const double gap = distances_[i].distance - pair.barrier.min_distance();
    const double square =
        squared_approach(&displacements[pair.edge_a], &displacements[pair.edge_b]);
    if (gap > 0.0 && square * share * share < max_loss * max_loss * gap * gap) {
      continue;
    }
    for (const std::uint32_t node : {pair.edge_a, pair.edge_a + 1, pair.edge_b, pair.edge_b + 1}) {
      ends[node] = rods.positions[node] + displacements[node];
    }
    const double left = (1.0 - max_loss) * std::max(0.0, gap);
    const ContactTime time = contact_time({&rods.positions[pair.edge_a],
                                           &ends[pair.edge_a],
                                           &rods.positions[pair.edge_b],
                                           &ends[pair.edge_b],
                                           {0.0, 0.0, pair.barrier.min_distance() + left}},
                                          tolerance * left);
    if (time.hit) {
      share = std::min(share, time.lower);
    }
  }
}

}  // namespace fiber
