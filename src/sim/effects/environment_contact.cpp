#include "fiber_proximity/sim/effects/environment_contact.hpp"

#include <algorithm>
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

/// Shortens a displacement to at most a length.
void limit_length(double most, Vector3d& displacement) {
  const double length = displacement.norm();
  if (length > std::max(0.0, most)) {
    displacement *= std::max(0.0, most) / length;
  }
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
  const double fastest = fastest_speed(rods);
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
    planes_.push_back({contact.fiber_a, is_last ? node - 1 : node, s, is_edge,
                       is_convex(object.shapes[contact.segment_b].shape), is_edge ? 0.0 : 1.0,
                       contact.point_b, -contact.normal});
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

void EnvironmentContact::share_contacts(const Rods& rods) {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Contact& contact = result_.contacts[i];
    if (!planes_[i].is_edge) {
      continue;
    }
    const std::size_t before = find_plane(contact.fiber_a, contact.segment_a - 1, contact);
    const std::size_t after = find_plane(contact.fiber_a, contact.segment_a + 1, contact);
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

/// The plane of another segment and the same shape, or how many there are if there is none.
std::size_t EnvironmentContact::find_plane(std::uint32_t rod, std::uint32_t segment,
                                           const Contact& like) const {
  const auto key = std::make_tuple(rod, segment, like.fiber_b, like.segment_b);
  const auto found = std::lower_bound(
      result_.contacts.begin(), result_.contacts.end(), key,
      [](const Contact& contact, const auto& wanted) { return contact.key() < wanted; });
  const bool is_there = found != result_.contacts.end() && found->key() == key;
  return is_there ? static_cast<std::size_t>(found - result_.contacts.begin()) : planes_.size();
}

void EnvironmentContact::measure(const Rods& rods) {
  heights_.clear();
  for (const Plane& plane : planes_) {
    const Vector3d point =
        (1.0 - plane.s) * rods.positions[plane.edge] + plane.s * rods.positions[plane.edge + 1];
    heights_.push_back(plane.normal.dot(point - plane.point));
  }
}

void EnvironmentContact::find(const Rods& rods, std::vector<ContactPoint>& points) const {
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Plane& plane = planes_[i];
    const double depth = rods.radii[plane.rod] - heights_[i];
    if (depth > 0.0 && plane.share > 0.0) {
      const double mass = std::min(rods.masses[plane.edge], rods.masses[plane.edge + 1]);
      const double stiffness = options_.stiffness > 0.0
                                   ? options_.stiffness
                                   : std::min(material_contact_stiffness(rods.sections[plane.rod],
                                                                         rods.radii[plane.rod]),
                                              largest_contact_stiffness(mass, step_));
      points.push_back({plane.edge, plane.s, ContactPoint::obstacle, 0.0, plane.point, plane.normal,
                        depth, plane.share * stiffness});
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

void EnvironmentContact::limit(const Rods& rods, std::vector<Vector3d>& displacements) {
  double farthest = 0.0;
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    const Vector3d target = rods.positions[i] + displacements[i];
    farthest = std::max(farthest, (target - fibers_.points()[2 * i]).norm());
  }
  if (farthest > margin_ && margin_ < longest_move_) {
    constexpr double rounding = 1.0 + 1e-9;
    look(rods, std::min(rounding * farthest, longest_move_));
    measure(rods);
  }
  for (std::size_t i = 0; i < displacements.size(); ++i) {
    const double moved = (rods.positions[i] - fibers_.points()[2 * i]).norm();
    limit_length(margin_ - moved, displacements[i]);
  }
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    const Plane& plane = planes_[i];
    if (!(heights_[i] > 0.0)) {
      continue;  // the axis is inside already
    }
    const std::uint32_t last = plane.edge + (plane.is_edge || plane.s == 1.0 ? 1 : 0);
    for (std::uint32_t node = last - (plane.is_edge ? 1 : 0); node <= last; ++node) {
      if (!plane.is_convex) {
        limit_length(free_distance(rods, plane), displacements[node]);
        continue;
      }
      const double height = plane.normal.dot(rods.positions[node] - plane.point);
      limit_approach(-plane.normal, height - least_distance * rods.radii[plane.rod],
                     displacements[node]);
    }
  }
}

}  // namespace fiber
