#include "src/sim/contact/friction_anchors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The two bodies of a contact, and the edge of the first.
auto key_of(const ContactPoints& points, std::uint32_t edge) {
  return std::tuple(points.rod_a, points.is_of_rods(), points.rod_b, edge);
}

bool is_before(const FrictionAnchors::Anchor& a, const FrictionAnchors::Anchor& b) {
  return key_of(a.points, a.points.edge_a) < key_of(b.points, b.points.edge_a);
}

/// The distance of two points of a rod [edges].
double edges_between(std::uint32_t edge, double parameter, std::uint32_t other_edge,
                     double other_parameter) {
  return std::abs(static_cast<double>(edge) - static_cast<double>(other_edge) + parameter -
                  other_parameter);
}

/// By what a slip is to be multiplied for this part of its energy: the root c of
/// c² (1 − c y/3) = part (1 − y/3), by Newton's method from above, where this is convex.
/// @param slip y, in parts of the stick length
double factor_for(double part, double slip) {
  if (part >= 1.0) {
    return 1.0;
  }
  double factor = std::sqrt(part);
  for (int i = 0; i < 4 && factor > 0.0; ++i) {
    const double excess = factor * factor * (1.0 - factor * slip / 3.0) - part * (1.0 - slip / 3.0);
    factor -= excess / (factor * (2.0 - factor * slip));
  }
  return factor;
}

}  // namespace

void FrictionAnchors::sort() {
  std::stable_sort(anchors_.begin(), anchors_.end(), is_before);
  energy_ = 0.0;
  for (const Anchor& anchor : anchors_) {
    energy_ += anchor.energy;
  }
}

Vector3d FrictionAnchors::slip_at(const ContactPoints& points, const Vector3d& normal,
                                  double max_force, double stick_length) const {
  const Anchor* const anchor = nearest(points, normal);
  if (anchor == nullptr) {
    return Vector3d::Zero();
  }
  const double length = anchor->slip.norm();
  const double energy = max_force * Friction::law(length * stick_length, stick_length).energy;
  const double factor = energy > 0.0 ? factor_for(anchor->energy / energy, length) : 1.0;
  return factor * stick_length * anchor->slip;
}

/// Null where none lies near enough.
const FrictionAnchors::Anchor* FrictionAnchors::nearest(const ContactPoints& points,
                                                        const Vector3d& normal) const {
  Anchor first{points, normal, Vector3d::Zero(), 0.0};
  first.points.edge_a = points.edge_a > 0 ? points.edge_a - 1 : 0;
  const Anchor* found = nullptr;
  double nearest = std::numeric_limits<double>::infinity();
  const auto last = key_of(points, points.edge_a + 1);
  for (auto anchor = std::lower_bound(anchors_.begin(), anchors_.end(), first, is_before);
       anchor != anchors_.end() && key_of(anchor->points, anchor->points.edge_a) <= last;
       ++anchor) {
    const ContactPoints& other = anchor->points;
    const double on_a = edges_between(points.edge_a, points.s, other.edge_a, other.s);
    const double on_b =
        points.is_of_rods() ? edges_between(points.edge_b, points.t, other.edge_b, other.t) : 0.0;
    // Where a node touches two faces, each goes on with its own.
    const double turn = 1.0 - normal.dot(anchor->normal);
    if (on_a <= 1.0 && on_b <= 1.0 && on_a + on_b + turn < nearest) {
      nearest = on_a + on_b + turn;
      found = &*anchor;
    }
  }
  return found;
}

}  // namespace fiber
