// The part that contacts have in a step of Newton's method: in its equations, and in how far it
// goes.

#include <algorithm>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/environment/convex_solids.hpp"
#include "src/environment/shape_contact_time.hpp"
#include "src/sim/contact/contact_set.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector2d;
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

/// Adds one side of a term to the rod it is on.
/// @param edge  of the rod
/// @param lever from the axis to the point
void add_side(std::uint32_t edge, double parameter, const SurfaceLever& lever,
              const Vector3d& gradient, const Matrix3d& hessian, RodSystem& system) {
  const SurfaceLever::Jacobian jacobian = lever.jacobian(parameter);
  const Eigen::Matrix<double, SurfaceLever::unknowns, 1> by_all = jacobian.transpose() * gradient;
  system.add_gradient(edge, by_all.head<3>());
  system.add_angle_gradient(edge, by_all[3]);
  system.add_gradient(edge + 1, by_all.tail<3>());
  const Eigen::Matrix<double, SurfaceLever::unknowns, SurfaceLever::unknowns> block =
      jacobian.transpose() * hessian * jacobian;
  const std::size_t first = std::size_t{edge} * system.unknowns();
  for (int c = 0; c < SurfaceLever::unknowns; ++c) {
    for (int r = c; r < SurfaceLever::unknowns; ++r) {
      system.add_hessian_entry(first + r, first + c, block(r, c));
    }
  }
}

/// Adds one side of a term whose points are on the axes.
/// @param node of the rod, where the edge begins
void add_side(std::uint32_t node, double parameter, const Vector3d& gradient,
              const Matrix3d& hessian, RodSystem& system) {
  const Vector2d weights(1.0 - parameter, parameter);
  system.add_gradient(node, weights[0] * gradient);
  system.add_gradient(node + 1, weights[1] * gradient);
  system.add_hessian(node, weights[0] * weights[0] * hessian);
  system.add_hessian(node + 1, weights[1] * weights[1] * hessian);
  system.add_hessian(node + 1, node, weights[0] * weights[1] * hessian);
}

/// Calls function(term) for all of them.
template <class Function>
void for_each_term(const ContactTerms& terms, const Function& function) {
  for (const std::vector<ContactTerm>& some : terms) {
    std::for_each(some.begin(), some.end(), function);
  }
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

void add_derivatives(const ContactTerms& terms, const Rods& rods,
                     const std::vector<RodSystem*>& systems,
                     const std::vector<std::uint32_t>& packs, std::uint32_t which) {
  for_each_term(terms, [&](const ContactTerm& term) {
    const ContactPoints& points = term.points;
    if (packs[points.rod_a] == which) {
      const std::uint32_t edge = points.edge_a - rods.first(points.rod_a);
      RodSystem& system = *systems[points.rod_a];
      if (term.levers == nullptr) {
        add_side(edge, points.s, term.gradient, term.hessian, system);
      } else {
        add_side(edge, points.s, term.levers->front(), term.gradient, term.hessian, system);
      }
      if (term.turning > 0.0) {
        system.add_edge(edge, Vector3d::Zero(),
                        term.turning * term.gradient * term.gradient.transpose());
      }
    }
    if (points.is_of_rods() && packs[points.rod_b] == which) {
      const std::uint32_t edge = points.edge_b - rods.first(points.rod_b);
      RodSystem& system = *systems[points.rod_b];
      if (term.levers == nullptr) {
        add_side(edge, points.t, -term.gradient, term.hessian, system);
      } else {
        add_side(edge, points.t, term.levers->back(), -term.gradient, term.hessian, system);
      }
    }
  });
}

bool has_coupling(const ContactTerms& terms) {
  return std::any_of(terms.begin(), terms.end(), [](const auto& some) {
    return std::any_of(some.begin(), some.end(),
                       [](const ContactTerm& term) { return term.points.is_of_rods(); });
  });
}

void add_coupling(const ContactTerms& terms, const std::vector<std::size_t>& places,
                  const SimdBatch* displacements, SimdBatch* product) {
  using Stride = Eigen::InnerStride<lane_count>;
  const auto displacement = [&](std::uint32_t node) {
    return Eigen::Map<const Vector3d, 0, Stride>(displacements->lanes.data() + places[node]);
  };
  const auto combine = [&](std::uint32_t edge, double parameter) -> Vector3d {
    return (1.0 - parameter) * displacement(edge) + parameter * displacement(edge + 1);
  };
  using Unknowns = Eigen::Matrix<double, SurfaceLever::unknowns, 1>;
  const auto combine_at = [&](std::uint32_t edge, double parameter,
                              const SurfaceLever& lever) -> Vector3d {
    return lever.jacobian(parameter) *
           Eigen::Map<const Unknowns, 0, Stride>(displacements->lanes.data() + places[edge]);
  };
  const auto spread_at = [&](std::uint32_t edge, double parameter, const SurfaceLever& lever,
                             const Vector3d& v) {
    Eigen::Map<Unknowns, 0, Stride>(product->lanes.data() + places[edge]) -=
        lever.jacobian(parameter).transpose() * v;
  };
  const auto spread = [&](std::uint32_t edge, double parameter, const Vector3d& v) {
    Eigen::Map<Vector3d, 0, Stride>(product->lanes.data() + places[edge]) -= (1.0 - parameter) * v;
    Eigen::Map<Vector3d, 0, Stride>(product->lanes.data() + places[edge + 1]) -= parameter * v;
  };
  for_each_term(terms, [&](const ContactTerm& term) {
    const ContactPoints& points = term.points;
    if (points.is_of_rods() && term.levers != nullptr) {
      const auto& [a, b] = *term.levers;
      const Vector3d from_a = term.hessian * combine_at(points.edge_a, points.s, a);
      const Vector3d from_b = term.hessian * combine_at(points.edge_b, points.t, b);
      spread_at(points.edge_a, points.s, a, from_b);
      spread_at(points.edge_b, points.t, b, from_a);
    } else if (points.is_of_rods()) {
      const Vector3d from_a = term.hessian * combine(points.edge_a, points.s);
      const Vector3d from_b = term.hessian * combine(points.edge_b, points.t);
      spread(points.edge_a, points.s, from_b);
      spread(points.edge_b, points.t, from_a);
    }
  });
}

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
  for (const FrictionPoint& point : frictions_) {
    frictions[point.contact] += point.force(rods, stick_length_);
  }
  DistanceTerms buffer;
  for (std::size_t i = 0; i < distance_count(); ++i) {
    if (energies_[i] == 0.0) {
      continue;
    }
    double force = 0.0;  // along the normals of all points of what may be returned [N]
    if (may_return(i)) {
      for_each_term(rods, i, buffer,
                    [&](const ContactPoints& /*points*/, const DistanceTerm& term) {
                      force += std::max(0.0, -term.slope);
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
        impact.returnable = step_ * std::max(0.0, -term.slope);
        impact.step_friction =
            force > 0.0 ? Vector3d(impact.returnable / force * frictions[i]) : Vector3d::Zero();
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
    if (moved != nullptr && !moved->has_arrived()) {
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
