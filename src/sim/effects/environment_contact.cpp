#include "fiber_proximity/sim/effects/environment_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "fiber_proximity/sim/contact_limits.hpp"
#include "fiber_proximity/sim/contact_stiffness.hpp"

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

bool is_convex(const Shape& shape) {
  return !std::holds_alternative<std::shared_ptr<const TriangleMesh>>(shape) &&
         !std::holds_alternative<std::shared_ptr<const OccupancyOctree>>(shape);
}

}  // namespace

EnvironmentContact::EnvironmentContact(std::shared_ptr<const Environment> environment,
                                       const Options& options)
    : environment_(std::move(environment)), options_(options) {
  validate_contact_stiffness("environment_contact", options.stiffness);
  for (const AllowedPair& pair : options.allowed) {
    allowed_.push_back(doubled(pair));
  }
}

void EnvironmentContact::set_environment(std::shared_ptr<const Environment> environment) {
  environment_ = std::move(environment);
}

void EnvironmentContact::begin_step(const Rods& rods, const TimeStep& step) {
  step_ = step.length;
  material_contact_stiffnesses(rods, material_stiffness_);
  const double fastest = std::sqrt(largest_square(rods.velocities));
  longest_move_ = longest_move(rods, step.length * fastest);
  place_fibers(rods);
  look(rods, *std::max_element(rods.radii.begin(), rods.radii.end()) + 2.0 * step.length * fastest);
  measure(rods);
}

void EnvironmentContact::look(const Rods& rods, double margin) {
  margin_ = margin;
  QueryOptions query;
  query.margin = margin;
  environment_->query(fibers_, query, allowed_, result_);
  planes_.clear();
  for (const Contact& contact : result_.contacts) {
    const bool is_edge = contact.segment_a % 2 == 1;
    // The last node is the end of the last edge.
    const std::uint32_t node = rods.first(contact.fiber_a) + contact.segment_a / 2;
    const bool is_last = !is_edge && node + 1 == rods.end(contact.fiber_a);
    const double s = is_edge ? contact.s : is_last ? 1.0 : 0.0;
    const EnvironmentObject& object = environment_->objects()[contact.fiber_b];
    const std::uint32_t edge = is_last ? node - 1 : node;
    planes_.push_back({contact.fiber_a, edge, s, is_edge,
                       is_convex(object.shapes[contact.segment_b].shape), is_edge ? 0.0 : 1.0,
                       stiffness_of(rods, contact.fiber_a, edge), contact.point_b,
                       -contact.normal});
  }
  share_contacts(rods);
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

double EnvironmentContact::stiffness_of(const Rods& rods, std::uint32_t rod,
                                        std::uint32_t edge) const {
  if (options_.stiffness > 0.0) {
    return options_.stiffness;
  }
  const double mass = std::min(rods.masses[edge], rods.masses[edge + 1]);
  return std::min(material_stiffness_[rod], largest_contact_stiffness(mass, step_));
}

void EnvironmentContact::share_contacts(const Rods& rods) {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Contact& contact = result_.contacts[i];
    if (!planes_[i].is_edge) {
      continue;
    }
    const std::size_t before = find_plane(i, contact.segment_a - 1);
    const std::size_t after = find_plane(i, contact.segment_a + 1);
    const auto gap_of = [this](std::size_t plane) {
      return plane < planes_.size() ? result_.contacts[plane].distance
                                    : std::numeric_limits<double>::infinity();
    };
    // Parallel to a flat side, an edge is no nearer than its ends but for rounding.
    constexpr double same = 1e-6;
    const double nearer = same * rods.radii[contact.fiber_a];
    if (contact.distance > std::min(gap_of(before), gap_of(after)) - nearer) {
      continue;
    }
    planes_[i].share = 1.0;
    if (before < planes_.size()) {
      planes_[before].share -= 1.0 - contact.s;
    }
    if (after < planes_.size()) {
      planes_[after].share -= contact.s;
    }
  }
}

/// The plane of the segment before or after that of another plane, and the same shape; or how many
/// there are if there is none. Contacts are in the order of their keys: it is not far.
std::size_t EnvironmentContact::find_plane(std::size_t near, std::uint32_t segment) const {
  const std::vector<Contact>& contacts = result_.contacts;
  const auto key = std::make_tuple(contacts[near].fiber_a, segment, contacts[near].fiber_b,
                                   contacts[near].segment_b);
  std::size_t found = near;
  while (found > 0 && contacts[found].key() > key) {
    --found;
  }
  while (found + 1 < contacts.size() && contacts[found].key() < key) {
    ++found;
  }
  return contacts[found].key() == key ? found : planes_.size();
}

void EnvironmentContact::measure(const Rods& rods) {
  heights_.clear();
  for (const Plane& plane : planes_) {
    const auto height = [&](std::uint32_t node) {
      return plane.normal.dot(rods.positions[node] - plane.point);
    };
    if (plane.is_edge) {
      const double first = height(plane.edge);
      const double last = height(plane.edge + 1);
      heights_.push_back({(1.0 - plane.s) * first + plane.s * last, std::min(first, last)});
    } else {
      const double at_node = height(plane.edge + (plane.s == 1.0 ? 1 : 0));
      heights_.push_back({at_node, at_node});
    }
  }
}

void EnvironmentContact::find(const Rods& rods, std::vector<ContactPoint>& points) const {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Plane& plane = planes_[i];
    const double depth = rods.radii[plane.rod] - heights_[i].nearest;
    if (depth > 0.0 && plane.share > 0.0) {
      points.push_back({plane.rod, plane.edge, plane.s, 0, ContactPoint::obstacle, 0.0, plane.point,
                        plane.normal, depth, plane.share * plane.stiffness});
    }
  }
}

/// How far the ends of the plane's edge, or its node, may still go without meeting what is not
/// convex [m].
double EnvironmentContact::free_distance(const Rods& rods, const Plane& plane) const {
  const auto was = [this](std::uint32_t node) { return fibers_.points()[std::size_t{2} * node]; };
  const Vector3d point = (1.0 - plane.s) * was(plane.edge) + plane.s * was(plane.edge + 1);
  double moved = 0.0;
  for (std::uint32_t node = plane.edge; node < plane.edge + 2; ++node) {
    moved = std::max(moved, (rods.positions[node] - was(node)).norm());
  }
  const double height = plane.normal.dot(point - plane.point);
  return height - least_distance * rods.radii[plane.rod] - moved;
}

void EnvironmentContact::limit(const Rods& rods, std::vector<Vector3d>& displacements, Way /*way*/,
                               int /*round*/) {
  limit_to_known(rods, displacements);
  const double longest = std::sqrt(largest_square(displacements));
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Plane& plane = planes_[i];
    const bool is_inside = !(heights_[i].nearest > 0.0);  // the axis, already
    const double room = heights_[i].lowest - least_distance * rods.radii[plane.rod];
    if (is_inside || (plane.is_convex && room >= longest)) {
      continue;
    }
    const std::uint32_t last = plane.edge + (plane.is_edge || plane.s == 1.0 ? 1 : 0);
    for (std::uint32_t node = last - (plane.is_edge ? 1 : 0); node <= last; ++node) {
      limit_to_side(rods, plane, node, displacements[node]);
    }
  }
}

/// Shortens displacements to within the margin; it grows first as far as it may.
void EnvironmentContact::limit_to_known(const Rods& rods, std::vector<Vector3d>& displacements) {
  const auto was = [this](std::size_t node) { return fibers_.points()[2 * node]; };
  double farthest_square = 0.0;
  double longest_square = 0.0;  // at least that of any way there and on
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    const Vector3d moved = rods.positions[i] - was(i);
    farthest_square = std::max(farthest_square, (moved + displacements[i]).squaredNorm());
    longest_square =
        std::max(longest_square, 2.0 * (moved.squaredNorm() + displacements[i].squaredNorm()));
  }
  if (longest_square <= margin_ * margin_) {
    return;
  }
  const double farthest = std::sqrt(farthest_square);
  if (farthest > margin_ && margin_ < longest_move_) {
    constexpr double rounding = 1.0 + 1e-9;
    look(rods, std::min(rounding * farthest, longest_move_));
    measure(rods);
  }
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    limit_length(margin_ - (rods.positions[i] - was(i)).norm(), displacements[i]);
  }
}

/// Shortens the displacement of a node to one that stays on its side of what a plane stands for.
void EnvironmentContact::limit_to_side(const Rods& rods, const Plane& plane, std::uint32_t node,
                                       Vector3d& displacement) const {
  if (!plane.is_convex) {
    limit_length(free_distance(rods, plane), displacement);
    return;
  }
  const double height = plane.normal.dot(rods.positions[node] - plane.point);
  limit_approach(-plane.normal, height - least_distance * rods.radii[plane.rod], displacement);
}

}  // namespace fiber
