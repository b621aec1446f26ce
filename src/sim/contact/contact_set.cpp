#include "contact_set.hpp"

#include <tbb/blocked_range.h>
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
  obstacle_points.clear();
  obstacle_edges.clear();
  frictions_.clear();
}

/// Calls function(points, normal, slope, curvature, barrier) for all distances that have a part in
/// the energy, those from obstacles first.
template <class Function>
void ContactSet::for_each_distance(const Rods& rods, const Function& function) const {
  for (std::size_t i = 0; i < obstacle_points.size(); ++i) {
    const ObstaclePoint& point = obstacle_points[i];
    const double distance = point.felt(obstacle_distances_[i].distance);
    const double depth_share = Barrier::depth_share(point.share);
    if (distance < point.barrier.outer) {
      function(PointPair{point.rod, point.edge, point.s, 0, no_edge, 0.0},
               obstacle_distances_[i].gradient,
               point.share * depth_share * point.barrier.slope(distance),
               point.share * depth_share * depth_share * point.barrier.curvature(distance),
               point.barrier);
    }
  }
  std::vector<DistanceTerm> found;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (distances_[i].distance >= pairs[i].barrier.outer) {
      continue;
    }
    found.clear();
    edge_contact(pairs[i], rods.positions, distances_[i], &found);
    for (const DistanceTerm& term : found) {
      function(PointPair{pairs[i].rod_a, pairs[i].edge_a, term.s, pairs[i].rod_b, pairs[i].edge_b,
                         term.t},
               term.normal, term.slope, term.curvature, pairs[i].barrier);
    }
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
  for_each_distance(rods, [&](const PointPair& points, const Vector3d& normal, double slope,
                              double /*curvature*/, const Barrier& /*barrier*/) {
    if (slope < 0.0) {
      Vector3d reference = point_at(references, points.edge_a, points.s);
      if (points.edge_b != no_edge) {
        reference -= point_at(references, points.edge_b, points.t);
      }
      frictions_.push_back({points, normal, -friction->coefficient() * slope, reference});
    }
  });
}

void ContactSet::measure(const Rods& rods) {
  constexpr std::size_t batch = 64;
  constexpr std::size_t batches_at_once = 16;
  obstacle_distances_.resize(obstacle_points.size());
  for (std::size_t i = 0; i < obstacle_points.size(); ++i) {
    const ObstaclePoint& point = obstacle_points[i];
    obstacle_distances_[i] =
        point.piece.distance_from(point_at(rods.positions, point.edge, point.s));
  }
  distances_.resize(pairs.size());
  const std::size_t batches = (pairs.size() + batch - 1) / batch;
  const auto measure_batch = [&](std::size_t index) {
    std::array<const Vector3d*, batch> a{};
    std::array<const Vector3d*, batch> b{};
    const std::size_t begin = index * batch;
    const std::size_t count = std::min(batch, pairs.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      a[i] = &rods.positions[pairs[begin + i].edge_a];
      b[i] = &rods.positions[pairs[begin + i].edge_b];
    }
    segment_distances(a.data(), b.data(), count, &distances_[begin]);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batches, batches_at_once),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        measure_batch(i);
                      }
                    });
}

Vector3d ContactSet::slip_of(const Rods& rods, const FrictionPoint& point) const {
  Vector3d moved = point_at(rods.positions, point.points.edge_a, point.points.s) - point.reference;
  if (point.points.edge_b != no_edge) {
    moved -= point_at(rods.positions, point.points.edge_b, point.points.t);
  }
  return moved - point.normal * point.normal.dot(moved);
}

void ContactSet::add_energies(const Rods& rods, const std::vector<std::uint32_t>& islands,
                              std::vector<EnergySum>& energies) const {
  for (std::size_t i = 0; i < obstacle_points.size(); ++i) {
    const ObstaclePoint& point = obstacle_points[i];
    energies[islands[point.rod]].add(
        point.share * point.barrier.energy(point.felt(obstacle_distances_[i].distance)));
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (distances_[i].distance < pairs[i].barrier.outer) {
      energies[islands[pairs[i].rod_a]].add(
          edge_contact(pairs[i], rods.positions, distances_[i], nullptr));
    }
  }
  for (const FrictionPoint& point : frictions_) {
    energies[islands[point.points.rod_a]].add(
        point.most * Friction::law(slip_of(rods, point).norm(), stick_length_).energy);
  }
}

double ContactSet::stored_energy(const Rods& rods) {
  measure(rods);
  double energy = 0.0;
  for (std::size_t i = 0; i < obstacle_points.size(); ++i) {
    const ObstaclePoint& point = obstacle_points[i];
    energy += point.share * point.barrier.energy(point.felt(obstacle_distances_[i].distance));
  }
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    energy += edge_contact(pairs[i], rods.positions, distances_[i], nullptr);
  }
  return energy;
}

void ContactSet::find_terms(const Rods& rods) {
  terms_.clear();
  for_each_distance(rods, [&](const PointPair& points, const Vector3d& normal, double slope,
                              double curvature, const Barrier& /*barrier*/) {
    terms_.push_back({points, slope * normal, curvature * normal * normal.transpose()});
  });
  for (const FrictionPoint& point : frictions_) {
    const Vector3d slip = slip_of(rods, point);
    const double length = slip.norm();
    const Friction::Law law = Friction::law(length, stick_length_);
    Matrix3d hessian =
        law.resistance * (Matrix3d::Identity() - point.normal * point.normal.transpose());
    if (length > 0.0) {
      const Vector3d along = slip / length;
      hessian += (law.curvature - law.resistance) * along * along.transpose();
    }
    terms_.push_back({point.points, point.most * law.resistance * slip, point.most * hessian});
  }
  const auto with_rods = std::stable_partition(
      terms_.begin(), terms_.end(), [](const Term& term) { return term.points.edge_b == no_edge; });
  coupling_begin_ = static_cast<std::size_t>(with_rods - terms_.begin());
}

void ContactSet::add_derivatives(const Rods& rods, const std::vector<RodSystem*>& systems) {
  find_terms(rods);
  for (const Term& term : terms_) {
    const PointPair& points = term.points;
    add_side(points.edge_a - rods.first(points.rod_a), points.s, term.gradient, term.hessian,
             *systems[points.rod_a]);
    if (points.edge_b != no_edge) {
      add_side(points.edge_b - rods.first(points.rod_b), points.t, -term.gradient, term.hessian,
               *systems[points.rod_b]);
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
  for (std::size_t i = coupling_begin_; i < terms_.size(); ++i) {
    const Term& term = terms_[i];
    const PointPair& points = term.points;
    const Vector3d from_a = term.hessian * combine(points.edge_a, points.s);
    const Vector3d from_b = term.hessian * combine(points.edge_b, points.t);
    spread(points.edge_a, points.s, from_b);
    spread(points.edge_b, points.t, from_a);
  }
}

void ContactSet::add_loads(const Rods& rods, std::vector<double>& loads) const {
  for_each_distance(rods, [&](const PointPair& points, const Vector3d& /*normal*/, double slope,
                              double /*curvature*/, const Barrier& barrier) {
    const double load = barrier.load_of(std::abs(slope));
    loads[points.rod_a] = std::max(loads[points.rod_a], load);
    if (points.edge_b != no_edge) {
      loads[points.rod_b] = std::max(loads[points.rod_b], load);
    }
  });
}

void ContactSet::add_forces(const Rods& rods, std::vector<RodForces::ContactForce>& forces) const {
  using Key = std::array<std::uint32_t, 4>;
  std::map<Key, std::size_t> places;
  const auto force_of = [&](const PointPair& points) -> RodForces::ContactForce& {
    const bool is_obstacle = points.edge_b == no_edge;
    const std::uint32_t rod_b = is_obstacle ? no_edge : points.rod_b;
    const std::uint32_t edge_b = is_obstacle ? 0 : points.edge_b - rods.first(points.rod_b);
    const Key key{points.rod_a, points.edge_a - rods.first(points.rod_a), rod_b, edge_b};
    const auto [place, is_new] = places.emplace(key, forces.size());
    if (is_new) {
      forces.push_back(
          {key[0], key[1], key[2], key[3], Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero()});
    }
    return forces[place->second];
  };
  std::map<std::size_t, double> weights;
  for_each_distance(rods, [&](const PointPair& points, const Vector3d& normal, double slope,
                              double /*curvature*/, const Barrier& /*barrier*/) {
    RodForces::ContactForce& force = force_of(points);
    const Vector3d on_a = point_at(rods.positions, points.edge_a, points.s);
    Vector3d between = on_a - rods.radii[points.rod_a] * normal;
    if (points.edge_b != no_edge) {
      const Vector3d on_b = point_at(rods.positions, points.edge_b, points.t);
      const double share =
          rods.radii[points.rod_a] / (rods.radii[points.rod_a] + rods.radii[points.rod_b]);
      between = on_a + share * (on_b - on_a);
    }
    force.normal_force -= slope * normal;
    force.point += std::abs(slope) * between;
    weights[static_cast<std::size_t>(&force - forces.data())] += std::abs(slope);
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
