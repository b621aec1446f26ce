#include "fiber_proximity/sim/effects/fiber_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fiber_proximity/sim/contact_limits.hpp"
#include "fiber_proximity/sim/contact_stiffness.hpp"
#include "fiber_proximity/sim/edge_pair.hpp"
#include "fiber_proximity/sim/edge_share.hpp"

namespace fiber {

using Eigen::Vector3d;

FiberContact::FiberContact(const Options& options) : options_(options) {
  validate_contact_stiffness("contact", options.stiffness);
  engine_ = make_engine("run_tree");
}

void FiberContact::begin_step(const Rods& rods, const TimeStep& step) {
  step_ = step.length;
  beginning_ = rods.positions;
  material_contact_stiffnesses(rods, material_stiffness_);
  longest_move_ = longest_move(rods, step.length * std::sqrt(largest_square(rods.velocities)));
  // What a node has moved since, and will in this step if nothing happens, must leave half of the
  // reach for what does happen. Where all move together, nothing comes nearer.
  displacements_.resize(rods.positions.size());
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    displacements_[i] = step.length * rods.velocities[i];
  }
  const bool is_first = fibers_.point_count() != rods.positions.size();
  const auto farthest_from = [&](const std::vector<Vector3d>& from) {
    return farthest_move(from, beginning_, displacements_,
                         mean_move(from, beginning_, displacements_));
  };
  if (is_first || farthest_from(fibers_.points()) > 0.25 * reach_) {
    constexpr double steps = 2.5;
    const double largest = *std::max_element(rods.radii.begin(), rods.radii.end());
    reach_ = 2.0 * largest + steps * farthest_from(beginning_);
    find_candidates(rods);
  }
  measure(rods);
  part_candidates(rods);
}

void FiberContact::find_candidates(const Rods& rods) {
  if (fibers_.point_count() != beginning_.size()) {
    fibers_ = FiberAssembly(beginning_, rods.offsets, rods.radii);
  } else {
    fibers_.update_points(beginning_);
  }
  engine_->update(fibers_);
  QueryOptions query;
  query.margin = reach_;
  query.pairing = options_.pairing;
  query.neighbour_skip = contact_neighbour_skip;
  engine_->query(query, result_);
  candidates_.clear();
  for (const Contact& contact : result_.contacts) {
    const Candidate candidate{contact.fiber_a, rods.first(contact.fiber_a) + contact.segment_a,
                              contact.fiber_b, rods.first(contact.fiber_b) + contact.segment_b};
    if (candidate.rod_a != candidate.rod_b ||
        !are_contact_neighbours(rods, candidate.edge_a, candidate.edge_b)) {
      candidates_.push_back(candidate);
    }
  }
}

double FiberContact::stiffness_of(const Rods& rods, const Candidate& candidate) const {
  if (options_.stiffness > 0.0) {
    return options_.stiffness;
  }
  const double mass = std::min({rods.masses[candidate.edge_a], rods.masses[candidate.edge_a + 1],
                                rods.masses[candidate.edge_b], rods.masses[candidate.edge_b + 1]});
  const double softer =
      std::min(material_stiffness_[candidate.rod_a], material_stiffness_[candidate.rod_b]);
  return std::min(softer, largest_contact_stiffness(mass, step_));
}

void FiberContact::measure(const Rods& rods) { measure_at(rods.positions); }

void FiberContact::measure_at(const std::vector<Vector3d>& positions) {
  constexpr std::size_t batch = 64;
  std::array<const Vector3d*, batch> a{};
  std::array<const Vector3d*, batch> b{};
  distances_.resize(candidates_.size());
  for (std::size_t begin = 0; begin < candidates_.size(); begin += batch) {
    const std::size_t count = std::min(batch, candidates_.size() - begin);
    for (std::size_t i = 0; i < count; ++i) {
      a[i] = &positions[candidates_[begin + i].edge_a];
      b[i] = &positions[candidates_[begin + i].edge_b];
    }
    segment_distances(a.data(), b.data(), count, &distances_[begin]);
  }
}

void FiberContact::find(const Rods& rods, std::vector<ContactPoint>& points) const {
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const Candidate& candidate = candidates_[i];
    const SegmentDistance& nearest = distances_[i];
    const double depth =
        rods.radii[candidate.rod_a] + rods.radii[candidate.rod_b] - nearest.distance;
    if (!(depth > 0.0) || nearest.distance == 0.0) {
      continue;
    }
    const auto point_at = [&rods](std::uint32_t edge, double parameter) -> Vector3d {
      return (1.0 - parameter) * rods.positions[edge] + parameter * rods.positions[edge + 1];
    };
    const Vector3d point_a = point_at(candidate.edge_a, nearest.s);
    const Vector3d point_b = point_at(candidate.edge_b, nearest.t);
    const auto slide = [&rods](std::uint32_t edge, double parameter) -> Vector3d {
      const bool is_inner = parameter > 0.0 && parameter < 1.0;
      return is_inner ? edge_direction(rods, edge).tangent : Vector3d::Zero();
    };
    const double share = edge_share(rods, candidate.rod_a, candidate.edge_a, nearest.s, point_b,
                                    slide(candidate.edge_b, nearest.t)) *
                         edge_share(rods, candidate.rod_b, candidate.edge_b, nearest.t, point_a,
                                    slide(candidate.edge_a, nearest.s));
    if (share > 0.0) {
      points.push_back({candidate.rod_a, candidate.edge_a, nearest.s, candidate.rod_b,
                        candidate.edge_b, nearest.t, point_b, -nearest.delta / nearest.distance,
                        depth, share * stiffness_of(rods, candidate)});
    }
  }
}

void FiberContact::part_candidates(const Rods& rods) {
  partings_.resize(candidates_.size());
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const SegmentDistance& nearest = distances_[i];
    if (nearest.distance == 0.0) {
      // They cross where the simulation began: there is no side to stay on.
      partings_[i] = {Vector3d::Zero(), 0.0};
      continue;
    }
    constexpr double share = 0.1;
    const double touching = rods.radii[candidates_[i].rod_a] + rods.radii[candidates_[i].rod_b];
    partings_[i] = {nearest.delta / nearest.distance,
                    std::max(share * nearest.distance, least_distance * touching)};
  }
}

}  // namespace fiber
