#include "fiber_proximity/sim/effects/environment_contact.hpp"

#include <algorithm>
#include <limits>

#include "src/sim/contact/contact_set.hpp"
#include "src/sim/contact/neighbours.hpp"
#include "src/sim/solver/step_bound.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

std::vector<Vector3d> doubled(const std::vector<Vector3d>& points) {
  std::vector<Vector3d> doubled;
  doubled.reserve(2 * points.size());
  for (const Vector3d& point : points) {
    doubled.push_back(point);
    doubled.push_back(point);
  }
  return doubled;
}

/// Edges first to last, and the nodes at their ends, as segments of the doubled fibres.
AllowedPair doubled(const AllowedPair& pair) {
  AllowedPair doubled = pair;
  doubled.first_segment = 2 * pair.first_segment + (pair.first_segment < 0 ? -1 : 0);
  doubled.last_segment = 2 * pair.last_segment + (pair.last_segment < 0 ? 1 : 2);
  return doubled;
}

}  // namespace

EnvironmentContact::EnvironmentContact(std::shared_ptr<const Environment> environment,
                                       const Options& options)
    : options_(options) {
  validate_contact_stiffness("environment_contact", options.stiffness);
  for (const AllowedPair& pair : options.allowed) {
    allowed_.push_back(doubled(pair));
  }
  set_environment(std::move(environment));
}

EnvironmentContact::~EnvironmentContact() = default;

void EnvironmentContact::set_environment(std::shared_ptr<const Environment> environment) {
  environment_ = std::move(environment);
  reach_ = -1.0;
  shapes_.clear();
  std::uint32_t index = 0;
  for (const EnvironmentObject& object : environment_->objects()) {
    shapes_.emplace_back();
    for (const PlacedShape& placed : object.shapes) {
      shapes_.back().emplace_back(placed.shape, object.pose * placed.pose, index);
    }
    ++index;
  }
}

void EnvironmentContact::place_fibers(const Rods& rods) {
  if (fibers_.point_count() == 2 * rods.positions.size()) {
    fibers_.update_points(doubled(rods.positions));
    return;
  }
  std::vector<std::uint32_t> offsets = rods.offsets;
  for (std::uint32_t& offset : offsets) {
    offset *= 2;
  }
  fibers_ = FiberAssembly(doubled(rods.positions), offsets, rods.radii);
}

void EnvironmentContact::find(const Rods& rods, const Room& room, ContactSet& found) {
  const double largest = *std::max_element(rods.radii.begin(), rods.radii.end());
  const bool was_asked = reach_ >= 0.0 && fibers_.point_count() == 2 * rods.positions.size();
  double most_needed = 0.0;
  double reached = 0.0;  // from where the environment was asked
  needed_.resize(rods.count());
  moved_.resize(rods.count());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    double expected = 0.0;
    double moved = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      expected = std::max(expected, room.expected[i].squaredNorm());
      if (was_asked) {
        const Vector3d way = rods.positions[i] - fibers_.points()[std::size_t{2} * i];
        moved = std::max(moved, way.squaredNorm());
      }
    }
    needed_[rod] = std::sqrt(expected) + room.by_rod[rod] + Barrier::half_width * largest;
    moved_[rod] = std::sqrt(moved);
    most_needed = std::max(most_needed, needed_[rod]);
    reached = std::max(reached, needed_[rod] + moved_[rod]);
  }
  // An answer that serves for some steps; one that was for faster motion finds too much.
  const double wanted = largest + 4.0 * most_needed;
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

/// @param contact when the environment was asked
/// @param within  [m] of axes now
void EnvironmentContact::add(const Rods& rods, const Contact& contact, double within,
                             ContactSet& found) const {
  const ObstacleShape& shape = shapes_[contact.fiber_b][contact.segment_b];
  const std::uint32_t rod = contact.fiber_a;
  const double radius = rods.radii[rod];
  const bool is_edge = contact.segment_a % 2 == 1;
  // The distance from a half-space is linear along an edge: its nodes say all.
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
         contact.distance + radius,
         contact.point_b,
         -contact.normal,
         {fibers_.points()[std::size_t{2} * edge], fibers_.points()[std::size_t{2} * edge + 2]}});
  }
  const Barrier barrier = Barrier::around(
      radius, options_.stiffness > 0.0 ? options_.stiffness
                                       : material_contact_stiffness(rods.sections[rod], radius));
  using Part = ObstacleContact::Part;
  const Part part = is_edge ? Part::EDGE : is_last ? Part::LAST_NODE : Part::FIRST_NODE;
  const auto add_piece = [&](const ObstaclePiece& piece) {
    found.obstacle_contacts.push_back({rod, edge, part, barrier, piece});
  };
  if (shape.is_convex()) {
    add_piece(ObstaclePiece(shape, {}));
    return;
  }
  const Vector3d& p0 = rods.positions[node];
  const Vector3d& p1 = is_edge ? rods.positions[node + 1] : p0;
  for (const ObstaclePiece& piece : near_pieces(shape, p0, p1, within)) {
    add_piece(piece);
  }
}

}  // namespace fiber
