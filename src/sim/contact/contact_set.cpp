#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "src/sim/contact/contact_set-inl.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

namespace {

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
  for (std::vector<Term>& terms : terms_) {
    terms.clear();
  }
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

void ContactSet::begin(const Rods& rods, const Friction* friction,
                       const std::vector<Vector3d>& references, double step) {
  frictions_.clear();
  measure(rods);
  let_part(rods);
  if (friction == nullptr) {
    return;
  }
  stick_length_ = friction->stick_length(step);
  std::vector<std::vector<FrictionPoint>> by_chunk(chunks_of(distance_count()));
  for_each_chunk(distance_count(), [&](std::size_t index, std::size_t begin, std::size_t end) {
    std::vector<DistanceTerm> room;
    const auto add = [&](const PointPair& points, const DistanceTerm& term,
                         const Barrier& /*barrier*/) {
      if (term.pressure > 0.0) {
        Vector3d reference = point_at(references, points.edge_a, points.s);
        if (points.edge_b != no_edge) {
          reference -= point_at(references, points.edge_b, points.t);
        }
        by_chunk[index].push_back(
            {points, term.normal, friction->coefficient() * term.pressure, reference});
      }
    };
    for (std::size_t i = begin; i < end; ++i) {
      visit(rods, i, room, add);
    }
  });
  for (const std::vector<FrictionPoint>& points : by_chunk) {
    frictions_.insert(frictions_.end(), points.begin(), points.end());
  }
}

/// What begins where its energy is infinite gets a barrier that begins nearer.
void ContactSet::let_part(const Rods& rods) {
  const auto judge = [&](std::size_t contact, double distance, Barrier& barrier) {
    // No part of a contact feels less than its distance, but for rounding.
    const double rounding = 1e-6 * barrier.width();
    if (!(distance > barrier.inner + rounding) && !std::isfinite(energy_of(rods, contact))) {
      barrier = barrier.for_start_at(distance);
    }
  };
  std::size_t contact = 0;
  for (std::size_t i = 0; i < obstacle_contacts.size(); ++i) {
    judge(contact++, obstacle_distances_[i].nearest.distance, obstacle_contacts[i].barrier);
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    judge(contact++, distances_[i].distance, pairs[i].barrier);
  }
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

double ContactSet::stored_energy() const {
  const auto end = energies_.begin() + static_cast<std::ptrdiff_t>(distance_count());
  return std::accumulate(energies_.begin(), end, 0.0);
}

double ContactSet::stiffening_energy(const std::vector<double>& before,
                                     const std::vector<double>& after) const {
  double energy = 0.0;
  std::size_t contact = 0;
  const auto add = [&](std::uint32_t rod_a, std::uint32_t rod_b) {
    const double growth =
        std::max(after[rod_a], after[rod_b]) / std::max(before[rod_a], before[rod_b]);
    energy += (growth - 1.0) * energies_[contact++];
  };
  for (const ObstacleContact& of_obstacle : obstacle_contacts) {
    add(of_obstacle.rod, of_obstacle.rod);
  }
  for (const EdgePair& pair : pairs) {
    add(pair.rod_a, pair.rod_b);
  }
  return energy;
}

void ContactSet::find_terms(const Rods& rods, std::size_t contact, std::vector<DistanceTerm>& found,
                            std::vector<Term>& terms) const {
  const auto add = [&](const PointPair& points, const DistanceTerm& term, const Barrier& barrier) {
    terms.push_back({points, term.slope * term.normal,
                     (term.curvature - term.across) * term.normal * term.normal.transpose() +
                         term.across * Matrix3d::Identity(),
                     term.turning > 0.0 ? term.turning / (term.slope * term.slope) : 0.0,
                     barrier.load_of(std::abs(term.slope))});
  };
  if (contact < distance_count()) {
    visit(rods, contact, found, add);
    return;
  }
  const FrictionPoint& point = frictions_[contact - distance_count()];
  const Vector3d slip = slip_of(rods, point);
  const double length = slip.norm();
  const Friction::Law law = Friction::law(length, stick_length_);
  Matrix3d hessian =
      law.resistance * (Matrix3d::Identity() - point.normal * point.normal.transpose());
  if (length > 0.0) {
    const Vector3d along = slip / length;
    hessian += (law.curvature - law.resistance) * along * along.transpose();
  }
  terms.push_back(
      {point.points, point.most * law.resistance * slip, point.most * hessian, 0.0, 0.0});
}

void ContactSet::find_derivatives(const Rods& rods) {
  terms_.resize(chunks_of(contact_count()));
  for_each_chunk(contact_count(), [&](std::size_t index, std::size_t begin, std::size_t end) {
    std::vector<DistanceTerm> found;
    terms_[index].clear();
    for (std::size_t i = begin; i < end; ++i) {
      find_terms(rods, i, found, terms_[index]);
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

}  // namespace fiber
