#include "fiber_proximity/sim/contacts.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "src/sim/contact/add_obstacle_contacts.hpp"
#include "src/sim/contact/contact_neighbours.hpp"
#include "src/sim/contact/contact_set.hpp"
#include "src/sim/effects/doubled_fibers.hpp"
#include "src/sim/require.hpp"
#include "src/sim/solver/step_bound.hpp"

namespace fiber {

using Eigen::Vector3d;

Friction::Friction(const Options& options) : options_(options) {
  require_not_negative("friction: the coefficient", options.coefficient);
  require_positive("friction: the stick speed", options.stick_speed, " m/s");
}

Friction::Law Friction::law(double slip, double stick_length) {
  const double share = slip / stick_length;
  if (share < 1.0) {
    return {stick_length * share * share * (1.0 - share / 3.0), (2.0 - share) / stick_length,
            2.0 * (1.0 - share) / stick_length};
  }
  return {slip - stick_length / 3.0, 1.0 / slip, 0.0};
}

namespace {

/// The largest distance of vectors from their mean.
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

/// An upper bound of how far two edges approach each other in a step [m].
double expected_approach(const TravelBound& bound, const EdgePair& pair) {
  double square = 0.0;
  for (std::uint32_t i = 0; i < 2; ++i) {
    for (std::uint32_t j = 0; j < 2; ++j) {
      const Vector3d way = bound.expected[pair.edge_a + i] - bound.expected[pair.edge_b + j];
      square = std::max(square, way.squaredNorm());
    }
  }
  return std::sqrt(square) + bound.by_rod[pair.rod_a] + bound.by_rod[pair.rod_b];
}

}  // namespace

FiberContact::FiberContact(const Options& options)
    : options_(options), engine_(make_engine("run_tree")) {
  require_not_negative("contact: the stiffness", options.stiffness, " N/m");
  require_share("contact: the restitution", options.restitution);
}

FiberContact::~FiberContact() = default;

void FiberContact::find(const Rods& rods, const TravelBound& bound, ContactSet& found) {
  const double expected = spread_of(bound.expected);
  const double largest = largest_of(rods.radii);
  const double needed = 2.0 * (Barrier::half_width * largest + expected + largest_of(bound.by_rod));
  double moved = 0.0;  // by rods beside each other since candidates were looked for
  if (fibers_.point_count() == rods.positions.size()) {
    ways_.resize(rods.positions.size());
    for (std::size_t i = 0; i < ways_.size(); ++i) {
      ways_[i] = rods.positions[i] - fibers_.points()[i];
    }
    moved = spread_of(ways_);
  }
  // The reach serves for some steps. One that was chosen for faster motion finds too many.
  const double wanted = needed + largest + 4.0 * expected;
  constexpr double too_far = 3.0;
  if (!(needed + 2.0 * moved <= reach_) || reach_ > too_far * wanted) {
    find_candidates(rods, wanted);
    moved = 0.0;
  }
  add_near(rods, bound, 2.0 * moved, found);
}

/// Adds the candidates that may be in contact within the step.
/// @param approach of any of them since they were found, at most [m]
void FiberContact::add_near(const Rods& rods, const TravelBound& bound, double approach,
                            ContactSet& found) {
  constexpr std::size_t batch = 64;
  std::array<const Vector3d*, batch> a{};
  std::array<const Vector3d*, batch> b{};
  std::array<std::size_t, batch> which{};
  std::array<double, batch> limits{};
  std::array<SegmentDistance, batch> distances;
  std::size_t count = 0;
  const auto add_batch = [&] {
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
    const double limit = pair.barrier.outer + expected_approach(bound, pair);
    if (candidate_distances_[i] - approach > limit) {
      continue;
    }
    a[count] = &rods.positions[pair.edge_a];
    b[count] = &rods.positions[pair.edge_b];
    which[count] = i;
    limits[count] = limit;
    if (++count == batch) {
      add_batch();
    }
  }
  add_batch();
}

void FiberContact::find_candidates(const Rods& rods, double reach) {
  if (fibers_.point_count() != rods.positions.size()) {
    fibers_ = FiberAssembly(rods.positions, rods.offsets, rods.radii);
    neighbours_ = std::make_unique<ContactNeighbours>(rods);
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
    if (!neighbours_->contain(rods, pair.rod_a, pair.edge_a, pair.rod_b, pair.edge_b)) {
      candidates_.push_back(pair);
      candidate_distances_.push_back(contact.distance + rods.radii[pair.rod_a] +
                                     rods.radii[pair.rod_b]);
    }
  }
}

/// Whether a pair of edges owns the contact of one of its four ends with the other edge. The edge
/// beyond that node, which is that across the seam at the ends of a closed rod, makes a pair with
/// the other edge that contains this contact, too. One of both pairs owns it, unless they have
/// barriers of their own, where the rod becomes thicker; or there is but one, as the rod ends, or
/// the edge beyond is too near the other one by way of a joint or a seam.
bool FiberContact::owns_node(const Rods& rods, const EdgePair& pair, std::uint32_t end) const {
  const bool is_of_a = end < 2;
  const std::uint32_t rod = is_of_a ? pair.rod_a : pair.rod_b;
  const std::uint32_t edge = is_of_a ? pair.edge_a : pair.edge_b;
  const std::uint32_t first = rods.first(rod);
  const std::uint32_t last = rods.end(rod) - 2;
  const bool is_begin = end % 2 == 0;
  const bool is_outermost = edge == (is_begin ? first : last);
  if (is_outermost && !rods.is_closed(rod)) {
    return true;
  }
  const std::uint32_t inner = is_begin ? edge - 1 : edge + 1;
  const std::uint32_t across = is_begin ? last : first;
  const std::uint32_t beyond = is_outermost ? across : inner;
  // In the order in which the query has that pair: lengths that are equal round alike.
  std::uint32_t a = is_of_a ? beyond : pair.edge_a;
  std::uint32_t b = is_of_a ? pair.edge_b : beyond;
  if (pair.rod_a == pair.rod_b && b < a) {
    std::swap(a, b);
  }
  if (rods.edge_radius(rod, beyond) != rods.edge_radius(rod, edge) ||
      neighbours_->contain(rods, pair.rod_a, a, pair.rod_b, b)) {
    return true;
  }
  return is_outermost ? edge == last : is_of_a == (edge < beyond);
}

EdgePair FiberContact::candidate(const Rods& rods, const Contact& contact) const {
  EdgePair pair;
  pair.rod_a = contact.fiber_a;
  pair.edge_a = rods.first(pair.rod_a) + contact.segment_a;
  pair.rod_b = contact.fiber_b;
  pair.edge_b = rods.first(pair.rod_b) + contact.segment_b;
  const double radius_a = rods.edge_radius(pair.rod_a, pair.edge_a);
  const double radius_b = rods.edge_radius(pair.rod_b, pair.edge_b);
  const double touching = radius_a + radius_b;
  const double stiffness =
      options_.stiffness > 0.0
          ? options_.stiffness
          : std::sqrt(material_contact_stiffness(rods.sections[pair.rod_a], touching) *
                      material_contact_stiffness(rods.sections[pair.rod_b], touching));
  pair.barrier = Barrier::around(touching, stiffness);
  pair.restitution = options_.restitution;
  pair.owns = {owns_node(rods, pair, 0), owns_node(rods, pair, 1), owns_node(rods, pair, 2),
               owns_node(rods, pair, 3)};
  for (std::uint32_t end = 0; end < 4; ++end) {
    const bool is_of_a = end < 2;
    const std::uint32_t other_rod = is_of_a ? pair.rod_b : pair.rod_a;
    const std::uint32_t other = is_of_a ? pair.edge_b : pair.edge_a;
    const std::uint32_t own_rod = is_of_a ? pair.rod_a : pair.rod_b;
    const std::uint32_t own = is_of_a ? pair.edge_a : pair.edge_b;
    const auto may_touch = [&](std::uint32_t edge) {
      return rods.edge_radius(other_rod, edge) == (is_of_a ? radius_b : radius_a) &&
             !neighbours_->contain(rods, own_rod, own, other_rod, edge);
    };
    pair.has_neighbour[end] = {other > rods.first(other_rod) && may_touch(other - 1),
                               other + 2 < rods.end(other_rod) && may_touch(other + 1)};
  }
  return pair;
}

EnvironmentContact::EnvironmentContact(std::shared_ptr<const Environment> environment,
                                       const Options& options)
    : environment_(std::move(environment)), options_(options) {
  require_not_negative("environment_contact: the stiffness", options.stiffness, " N/m");
  require_share("environment_contact: the restitution", options.restitution);
  for (const AllowedPair& pair : options.allowed) {
    allowed_.push_back(doubled(pair));
  }
  std::uint32_t index = 0;
  for (const EnvironmentObject& object : environment_->objects()) {
    shapes_.emplace_back();
    for (const PlacedShape& placed : object.shapes) {
      shapes_.back().emplace_back(placed.shape, object.pose * placed.pose, index);
    }
    ++index;
  }
}

EnvironmentContact::~EnvironmentContact() = default;

void EnvironmentContact::place_fibers(const Rods& rods) {
  if (fibers_.point_count() == 2 * rods.positions.size()) {
    fibers_.update_points(doubled(rods.positions));
    return;
  }
  fibers_ = doubled_fibers(rods);
}

void EnvironmentContact::find(const Rods& rods, const TravelBound& bound, ContactSet& found) {
  const double largest = *std::max_element(rods.radii.begin(), rods.radii.end());
  const bool was_asked = reach_ >= 0.0 && fibers_.point_count() == 2 * rods.positions.size();
  double max_needed = 0.0;
  double reached = 0.0;  // from the positions of the last query
  needed_.resize(rods.count());
  moved_.resize(rods.count());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    double expected = 0.0;
    double moved = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      expected = std::max(expected, bound.expected[i].squaredNorm());
      if (was_asked) {
        const Vector3d way = rods.positions[i] - fibers_.points()[std::size_t{2} * i];
        moved = std::max(moved, way.squaredNorm());
      }
    }
    needed_[rod] = std::sqrt(expected) + bound.by_rod[rod] + Barrier::half_width * largest;
    moved_[rod] = std::sqrt(moved);
    max_needed = std::max(max_needed, needed_[rod]);
    reached = std::max(reached, needed_[rod] + moved_[rod]);
  }
  // The answer serves for some steps. One that was asked for faster motion contains too much.
  const double wanted = largest + 4.0 * max_needed;
  constexpr double too_far = 3.0;
  if (!was_asked || !(reached <= reach_) || reach_ > too_far * wanted) {
    place_fibers(rods);
    QueryOptions query;
    query.margin = reach_ = wanted;
    environment_->query(fibers_, query, allowed_, result_);
    std::fill(moved_.begin(), moved_.end(), 0.0);
  }
  for (const Contact& contact : result_.contacts) {
    if (contact.distance <= needed_[contact.fiber_a] + moved_[contact.fiber_a]) {
      add(rods, contact, needed_[contact.fiber_a] + largest, found);
    }
  }
}

/// @param contact as the last query has found it
/// @param within  [m] of axes now
void EnvironmentContact::add(const Rods& rods, const Contact& contact, double within,
                             ContactSet& found) const {
  const ObstacleShape& shape = shapes_[contact.fiber_b][contact.segment_b];
  const std::uint32_t rod = contact.fiber_a;
  const bool is_edge = contact.segment_a % 2 == 1;
  // The distance from a half-space is linear along an edge, so that its nodes suffice.
  if (is_edge && std::holds_alternative<HalfSpaceShape>(*shape.shape)) {
    return;
  }
  const std::uint32_t node = rods.first(rod) + contact.segment_a / 2;
  // The last node is the end of the last edge.
  const bool is_last = !is_edge && node + 1 == rods.end(rod);
  const std::uint32_t edge = is_last ? node - 1 : node;
  if (is_edge) {
    found.obstacle_edges.push_back(
        {rod,
         edge,
         &shape,
         contact.distance + rods.radii[rod],
         contact.point_b,
         -contact.normal,
         {fibers_.points()[std::size_t{2} * edge], fibers_.points()[std::size_t{2} * edge + 2]}});
  }
  const EdgePart part = is_edge   ? EdgePart::whole()
                        : is_last ? EdgePart::last_node()
                                  : EdgePart::first_node();
  add_obstacle_contacts(shape, rods, rod, edge, part, options_, within, found.obstacle_contacts);
}

}  // namespace fiber
