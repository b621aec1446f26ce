#include "fiber_proximity/sim/effects/fiber_contact.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/sim/contact/contact_set.hpp"
#include "src/sim/contact/neighbours.hpp"
#include "src/sim/solver/step_bound.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The most by which vectors differ from their mean.
double spread_of(const std::vector<Vector3d>& vectors) {
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& vector : vectors) {
    mean += vector;
  }
  mean /= static_cast<double>(vectors.size());
  double largest = 0.0;
  for (const Vector3d& vector : vectors) {
    largest = std::max(largest, (vector - mean).squaredNorm());
  }
  return std::sqrt(largest);
}

double largest_of(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

/// How much further two edges may come towards each other than their nodes' room allows [m].
double expected_approach(const Room& room, const EdgePair& pair) {
  double square = 0.0;
  for (std::uint32_t i = 0; i < 2; ++i) {
    for (std::uint32_t j = 0; j < 2; ++j) {
      const Vector3d way = room.expected[pair.edge_a + i] - room.expected[pair.edge_b + j];
      square = std::max(square, way.squaredNorm());
    }
  }
  return std::sqrt(square) + room.by_rod[pair.rod_a] + room.by_rod[pair.rod_b];
}

}  // namespace

FiberContact::FiberContact(const Options& options)
    : options_(options), engine_(make_engine("run_tree")) {
  validate_contact_stiffness("contact", options.stiffness);
}

FiberContact::~FiberContact() = default;

void FiberContact::find(const Rods& rods, const Room& room, ContactSet& found) {
  const double expected = spread_of(room.expected);
  const double largest = largest_of(rods.radii);
  const double needed = 2.0 * (Barrier::half_width * largest + expected + largest_of(room.by_rod));
  double moved = 0.0;  // by rods beside each other since candidates were looked for
  if (fibers_.point_count() == rods.positions.size()) {
    std::vector<Vector3d> ways(rods.positions.size());
    for (std::size_t i = 0; i < ways.size(); ++i) {
      ways[i] = rods.positions[i] - fibers_.points()[i];
    }
    moved = spread_of(ways);
  }
  // A reach that serves for some steps; one that was for faster motion finds too much.
  const double wanted = needed + largest + 4.0 * expected;
  constexpr double too_far = 3.0;
  if (!(needed + 2.0 * moved <= reach_) || reach_ > too_far * wanted) {
    find_candidates(rods, wanted);
    moved = 0.0;
  }
  add_near(rods, room, 2.0 * moved, found);
}

/// Adds candidates that are near enough for the step.
/// @param approach by which any may have come nearer since they were found [m]
void FiberContact::add_near(const Rods& rods, const Room& room, double approach,
                            ContactSet& found) {
  constexpr std::size_t batch = 64;
  std::array<const Vector3d*, batch> a{};
  std::array<const Vector3d*, batch> b{};
  std::array<std::size_t, batch> which{};
  std::array<double, batch> limits{};
  std::array<SegmentDistance, batch> distances;
  std::size_t count = 0;
  const auto measure = [&] {
    segment_distances(a.data(), b.data(), count, distances.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (distances[i].distance <= limits[i]) {
        found.pairs.push_back(candidates_[which[i]]);
      }
    }
    count = 0;
  };
  for (std::size_t i = 0; i < candidates_.size(); ++i) {
    const EdgePair& pair = candidates_[i];
    const double limit = pair.barrier.outer + expected_approach(room, pair);
    if (candidate_distances_[i] - approach > limit) {
      continue;
    }
    a[count] = &rods.positions[pair.edge_a];
    b[count] = &rods.positions[pair.edge_b];
    which[count] = i;
    limits[count] = limit;
    if (++count == batch) {
      measure();
    }
  }
  measure();
}

void FiberContact::find_candidates(const Rods& rods, double reach) {
  if (fibers_.point_count() != rods.positions.size()) {
    fibers_ = FiberAssembly(rods.positions, rods.offsets, rods.radii);
    arcs_ = contact_arcs(rods);
  } else {
    fibers_.update_points(rods.positions);
  }
  reach_ = reach;
  engine_->update(fibers_);
  QueryOptions query;
  query.margin = reach;
  query.pairing = options_.pairing;
  query.neighbour_skip = contact_neighbour_skip;
  engine_->query(query, result_);
  candidates_.clear();
  candidate_distances_.clear();
  for (const Contact& contact : result_.contacts) {
    const EdgePair pair = candidate(rods, contact);
    if (pair.rod_a != pair.rod_b ||
        !are_contact_neighbours(rods, arcs_, pair.rod_a, pair.edge_a, pair.edge_b)) {
      candidates_.push_back(pair);
      candidate_distances_.push_back(contact.distance + rods.radii[pair.rod_a] +
                                     rods.radii[pair.rod_b]);
    }
  }
}

EdgePair FiberContact::candidate(const Rods& rods, const Contact& contact) const {
  EdgePair pair;
  pair.rod_a = contact.fiber_a;
  pair.edge_a = rods.first(pair.rod_a) + contact.segment_a;
  pair.rod_b = contact.fiber_b;
  pair.edge_b = rods.first(pair.rod_b) + contact.segment_b;
  const double touching = rods.radii[pair.rod_a] + rods.radii[pair.rod_b];
  const double stiffness =
      options_.stiffness > 0.0
          ? options_.stiffness
          : std::sqrt(material_contact_stiffness(rods.sections[pair.rod_a], touching) *
                      material_contact_stiffness(rods.sections[pair.rod_b], touching));
  pair.barrier = Barrier::around(touching, stiffness);
  // Of the pairs that a node's two edges make with another edge, the one further along the rod owns
  // the node's contact: it is there if the other one is.
  pair.owns = {pair.edge_a == rods.first(pair.rod_a), true, true,
               pair.edge_b + 2 == rods.end(pair.rod_b)};
  const auto may_touch = [&](std::uint32_t edge_a, std::uint32_t edge_b) {
    return pair.rod_a != pair.rod_b ||
           !are_contact_neighbours(rods, arcs_, pair.rod_a, edge_a, edge_b);
  };
  for (std::uint32_t end = 0; end < 4; ++end) {
    const bool is_of_a = end < 2;
    const std::uint32_t other_rod = is_of_a ? pair.rod_b : pair.rod_a;
    const std::uint32_t other = is_of_a ? pair.edge_b : pair.edge_a;
    const std::uint32_t own = is_of_a ? pair.edge_a : pair.edge_b;
    pair.has_neighbour[end] = {other > rods.first(other_rod) && may_touch(own, other - 1),
                               other + 2 < rods.end(other_rod) && may_touch(own, other + 1)};
  }
  return pair;
}

}  // namespace fiber
