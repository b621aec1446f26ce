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
  clear_within_ = 0.0;
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
  double approach = 0.0;  // that the step may bring
  double moved = 0.0;     // since the environment was asked
  const bool was_asked = fibers_.point_count() == 2 * rods.positions.size();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    double longest = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      longest = std::max(longest, room.expected[i].squaredNorm());
      if (was_asked) {
        const Vector3d way = rods.positions[i] - fibers_.points()[std::size_t{2} * i];
        moved = std::max(moved, way.squaredNorm());
      }
    }
    approach = std::max(approach, std::sqrt(longest) + room.by_rod[rod]);
  }
  const double largest = *std::max_element(rods.radii.begin(), rods.radii.end());
  const double needed = approach + Barrier::half_width * largest;
  if (was_asked && needed + std::sqrt(moved) <= clear_within_) {
    return;
  }
  place_fibers(rods);
  QueryOptions query;
  // Far from everything, an answer serves for some steps.
  query.margin = clear_within_ > 0.0 ? needed + largest + 4.0 * approach : needed;
  environment_->query(fibers_, query, allowed_, result_);
  clear_within_ = result_.contacts.empty() ? query.margin : 0.0;
  for (const Contact& contact : result_.contacts) {
    add(rods, contact, query.margin + largest, found);
  }
}

/// @param within [m] of axes
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
    found.obstacle_edges.push_back({rod,
                                    edge,
                                    &shape,
                                    contact.distance + radius,
                                    contact.point_b,
                                    -contact.normal,
                                    {rods.positions[edge], rods.positions[edge + 1]}});
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
