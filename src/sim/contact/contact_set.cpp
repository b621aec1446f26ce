#include "contact_set.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <map>

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

Vector3d point_at(const std::vector<Vector3d>& of_nodes, std::uint32_t edge, double parameter) {
  return (1.0 - parameter) * of_nodes[edge] + parameter * of_nodes[edge + 1];
}

/// Adds one side of a term to the rod it is on.
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

}  // namespace

void ContactSet::clear() {
  pairs.clear();
  obstacle_contacts.clear();
  obstacle_edges.clear();
  frictions_.clear();
}

void ContactSet::append(const ContactSet& other) {
  pairs.insert(pairs.end(), other.pairs.begin(), other.pairs.end());
  obstacle_contacts.insert(obstacle_contacts.end(), other.obstacle_contacts.begin(),
                           other.obstacle_contacts.end());
  obstacle_edges.insert(obstacle_edges.end(), other.obstacle_edges.begin(),
                        other.obstacle_edges.end());
}

// Contacts are numbered: those with obstacles, those of pairs, those that have friction. Threads
// take them in chunks, which do not depend on how many threads there are.
namespace {

constexpr std::size_t chunk = 64;

std::size_t chunks_of(std::size_t count) { return (count + chunk - 1) / chunk; }

/// Calls function(chunk, begin, end) in parallel.
template <class Function>
void for_each_chunk(std::size_t count, const Function& function) {
  tbb::parallel_for(std::size_t{0}, chunks_of(count), [&](std::size_t index) {
    function(index, index * chunk, std::min(count, (index + 1) * chunk));
  });
}

}  // namespace

/// Calls function(points, term, barrier) for what the contact has of the energy.
/// @param found room for these terms
template <class Function>
void ContactSet::visit_obstacle(std::size_t index, std::vector<DistanceTerm>& found,
                                const Function& function) const {
  const ObstacleContact& contact = obstacle_contacts[index];
  found.clear();
  obstacle_contact(contact, obstacle_distances_[index], &found);
  for (const DistanceTerm& term : found) {
    function(PointPair{contact.rod, contact.edge, term.s, contact.piece.object(), no_edge, 0.0},
             term, contact.barrier);
  }
}

/// The same of a pair.
template <class Function>
void ContactSet::visit_pair(const Rods& rods, std::size_t index, std::vector<DistanceTerm>& found,
                            const Function& function) const {
  const EdgePair& pair = pairs[index];
  if (distances_[index].distance >= pair.barrier.outer) {
    return;
  }
  found.clear();
  edge_contact(pair, rods.positions, distances_[index], &found);
  for (const DistanceTerm& term : found) {
    function(PointPair{pair.rod_a, pair.edge_a, term.s, pair.rod_b, pair.edge_b, term.t}, term,
             pair.barrier);
  }
}

template <class Function>
void ContactSet::for_each_distance(const Rods& rods, const Function& function) const {
  std::vector<DistanceTerm> found;
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    visit_obstacle(i, found, function);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    visit_pair(rods, i, found, function);
  }
}

void ContactSet::begin(const Rods& rods, const Friction* friction,
                       const std::vector<Vector3d>& references, double step) {
  frictions_.clear();
  measure(rods);
  if (friction == nullptr) {
    return;
  }
  stick_length_ = friction->stick_length(step);
  for_each_distance(
      rods, [&](const PointPair& points, const DistanceTerm& term, const Barrier& /*barrier*/) {
        if (term.pressure > 0.0) {
          Vector3d reference = point_at(references, points.edge_a, points.s);
          if (points.edge_b != no_edge) {
            reference -= point_at(references, points.edge_b, points.t);
          }
          frictions_.push_back(
              {points, term.normal, friction->coefficient() * term.pressure, reference});
        }
      });
}

void ContactSet::measure(const Rods& rods) {
  obstacle_distances_.resize(obstacle_contacts.size());
  for_each_chunk(
      obstacle_contacts.size(), [&](std::size_t /*index*/, std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          obstacle_distances_[i] = obstacle_distance(obstacle_contacts[i], rods.positions);
        }
      });
  distances_.resize(pairs.size());
  for_each_chunk(pairs.size(), [&](std::size_t /*index*/, std::size_t begin, std::size_t end) {
    std::array<const Vector3d*, chunk> a{};
    std::array<const Vector3d*, chunk> b{};
    for (std::size_t i = begin; i < end; ++i) {
      a[i - begin] = &rods.positions[pairs[i].edge_a];
      b[i - begin] = &rods.positions[pairs[i].edge_b];
    }
    segment_distances(a.data(), b.data(), end - begin, &distances_[begin]);
  });
}

Vector3d ContactSet::slip_of(const Rods& rods, const FrictionPoint& point) const {
  Vector3d moved = point_at(rods.positions, point.points.edge_a, point.points.s) - point.reference;
  if (point.points.edge_b != no_edge) {
    moved -= point_at(rods.positions, point.points.edge_b, point.points.t);
  }
  return moved - point.normal * point.normal.dot(moved);
}

double ContactSet::energy_of(const Rods& rods, std::size_t contact) const {
  if (contact < obstacle_contacts.size()) {
    return obstacle_contact(obstacle_contacts[contact], obstacle_distances_[contact], nullptr);
  }
  contact -= obstacle_contacts.size();
  if (contact < pairs.size()) {
    return edge_contact(pairs[contact], rods.positions, distances_[contact], nullptr);
  }
  const FrictionPoint& point = frictions_[contact - pairs.size()];
  return point.most * Friction::law(slip_of(rods, point).norm(), stick_length_).energy;
}

void ContactSet::add_energies(const Rods& rods, const std::vector<std::uint32_t>& islands,
                              std::vector<EnergySum>& energies) {
  energies_.resize(contact_count());
  for_each_chunk(energies_.size(), [&](std::size_t /*index*/, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      energies_[i] = energy_of(rods, i);
    }
  });
  std::size_t contact = 0;
  for (const ObstacleContact& of_obstacle : obstacle_contacts) {
    energies[islands[of_obstacle.rod]].add(energies_[contact++]);
  }
  for (const EdgePair& pair : pairs) {
    energies[islands[pair.rod_a]].add(energies_[contact++]);
  }
  for (const FrictionPoint& point : frictions_) {
    energies[islands[point.points.rod_a]].add(energies_[contact++]);
  }
}

double ContactSet::stored_energy(const Rods& rods) {
  measure(rods);
  double energy = 0.0;
  for (std::size_t i = 0; i < obstacle_contacts.size() + pairs.size(); ++i) {
    energy += energy_of(rods, i);
  }
  return energy;
}

void ContactSet::find_terms(const Rods& rods, std::size_t contact, std::vector<Term>& terms) const {
  const auto add = [&](const PointPair& points, const DistanceTerm& term,
                       const Barrier& /*barrier*/) {
    terms.push_back({points, term.slope * term.normal,
                     term.curvature * term.normal * term.normal.transpose(),
                     term.turning > 0.0 ? term.turning / (term.slope * term.slope) : 0.0});
  };
  std::vector<DistanceTerm> found;
  if (contact < obstacle_contacts.size()) {
    visit_obstacle(contact, found, add);
    return;
  }
  contact -= obstacle_contacts.size();
  if (contact < pairs.size()) {
    visit_pair(rods, contact, found, add);
    return;
  }
  const FrictionPoint& point = frictions_[contact - pairs.size()];
  const Vector3d slip = slip_of(rods, point);
  const double length = slip.norm();
  const Friction::Law law = Friction::law(length, stick_length_);
  Matrix3d hessian =
      law.resistance * (Matrix3d::Identity() - point.normal * point.normal.transpose());
  if (length > 0.0) {
    const Vector3d along = slip / length;
    hessian += (law.curvature - law.resistance) * along * along.transpose();
  }
  terms.push_back({point.points, point.most * law.resistance * slip, point.most * hessian, 0.0});
}

void ContactSet::find_derivatives(const Rods& rods) {
  terms_.resize(chunks_of(contact_count()));
  for_each_chunk(contact_count(), [&](std::size_t index, std::size_t begin, std::size_t end) {
    terms_[index].clear();
    for (std::size_t i = begin; i < end; ++i) {
      find_terms(rods, i, terms_[index]);
    }
  });
  has_coupling_ = std::any_of(terms_.begin(), terms_.end(), [](const std::vector<Term>& terms) {
    return std::any_of(terms.begin(), terms.end(),
                       [](const Term& term) { return term.points.edge_b != no_edge; });
  });
}

void ContactSet::add_derivatives(const Rods& rods, const std::vector<RodSystem*>& systems,
                                 const std::vector<std::uint32_t>& packs,
                                 std::uint32_t which) const {
  for (const std::vector<Term>& terms : terms_) {
    for (const Term& term : terms) {
      const PointPair& points = term.points;
      if (packs[points.rod_a] == which) {
        const std::uint32_t edge = points.edge_a - rods.first(points.rod_a);
        add_side(edge, points.s, term.gradient, term.hessian, *systems[points.rod_a]);
        if (term.turning > 0.0) {
          systems[points.rod_a]->add_edge(edge, Vector3d::Zero(),
                                          term.turning * term.gradient * term.gradient.transpose());
        }
      }
      if (points.edge_b != no_edge && packs[points.rod_b] == which) {
        add_side(points.edge_b - rods.first(points.rod_b), points.t, -term.gradient, term.hessian,
                 *systems[points.rod_b]);
      }
    }
  }
}

void ContactSet::add_coupling(const std::vector<std::size_t>& places, const double* displacements,
                              double* product) const {
  using Stride = Eigen::InnerStride<lane_count>;
  const auto displacement = [&](std::uint32_t node) {
    return Eigen::Map<const Vector3d, 0, Stride>(displacements + places[node]);
  };
  const auto combine = [&](std::uint32_t edge, double parameter) -> Vector3d {
    return (1.0 - parameter) * displacement(edge) + parameter * displacement(edge + 1);
  };
  const auto spread = [&](std::uint32_t edge, double parameter, const Vector3d& v) {
    Eigen::Map<Vector3d, 0, Stride>(product + places[edge]) -= (1.0 - parameter) * v;
    Eigen::Map<Vector3d, 0, Stride>(product + places[edge + 1]) -= parameter * v;
  };
  for (const std::vector<Term>& terms : terms_) {
    for (const Term& term : terms) {
      const PointPair& points = term.points;
      if (points.edge_b != no_edge) {
        const Vector3d from_a = term.hessian * combine(points.edge_a, points.s);
        const Vector3d from_b = term.hessian * combine(points.edge_b, points.t);
        spread(points.edge_a, points.s, from_b);
        spread(points.edge_b, points.t, from_a);
      }
    }
  }
}

void ContactSet::add_loads(const Rods& rods, std::vector<double>& loads) const {
  for_each_distance(rods,
                    [&](const PointPair& points, const DistanceTerm& term, const Barrier& barrier) {
                      const double load = barrier.load_of(std::abs(term.slope));
                      loads[points.rod_a] = std::max(loads[points.rod_a], load);
                      if (points.edge_b != no_edge) {
                        loads[points.rod_b] = std::max(loads[points.rod_b], load);
                      }
                    });
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
