#include "src/sim/contact/friction_anchors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace fiber {

using Eigen::Vector3d;

namespace {

bool is_between_same_bodies(const ContactPoints& a, const ContactPoints& b) {
  return a.rod_a == b.rod_a && a.rod_b == b.rod_b && a.is_of_rods() == b.is_of_rods();
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

void FrictionAnchors::sort(std::size_t edges) {
  energy_ = 0.0;
  if (anchors_.empty()) {
    return;
  }
  offsets_.assign(edges + 1, 0);
  for (const Anchor& anchor : anchors_) {
    ++offsets_[anchor.points.edge_a];
  }
  std::partial_sum(offsets_.begin(), offsets_.end(), offsets_.begin());
  by_edge_.resize(anchors_.size());
  for (std::size_t i = anchors_.size(); i-- > 0;) {
    by_edge_[--offsets_[anchors_[i].points.edge_a]] = static_cast<std::uint32_t>(i);
  }
  for (const std::uint32_t i : by_edge_) {
    energy_ += anchors_[i].energy;
  }
}

void FrictionAnchors::remove_object(std::uint32_t object) {
  const auto is_at = [object](const Anchor& anchor) {
    return !anchor.points.is_of_rods() && anchor.points.rod_b == object;
  };
  anchors_.erase(std::remove_if(anchors_.begin(), anchors_.end(), is_at), anchors_.end());
  for (Anchor& anchor : anchors_) {
    anchor.points.rod_b -= !anchor.points.is_of_rods() && anchor.points.rod_b > object ? 1U : 0U;
  }
  sort(offsets_.empty() ? 0 : offsets_.size() - 1);
}

Vector3d FrictionAnchors::slip_from(const Anchor& anchor, double max_force, double stick_length) {
  const double length = anchor.slip.norm();
  const double energy = max_force * Friction::law(length * stick_length, stick_length).energy;
  const double factor = energy > 0.0 ? factor_for(anchor.energy / energy, length) : 1.0;
  return factor * stick_length * anchor.slip;
}

const FrictionAnchors::Anchor* FrictionAnchors::nearest(const ContactPoints& points,
                                                        const Vector3d& normal) const {
  if (anchors_.empty()) {
    return nullptr;
  }
  const Anchor* found = nullptr;
  double nearest = std::numeric_limits<double>::infinity();
  const std::size_t last = std::min<std::size_t>(points.edge_a + 2, offsets_.size() - 1);
  for (std::size_t i = offsets_[points.edge_a - std::min(points.edge_a, 1U)]; i < offsets_[last];
       ++i) {
    const Anchor& anchor = anchors_[by_edge_[i]];
    const ContactPoints& other = anchor.points;
    if (!is_between_same_bodies(points, other)) {
      continue;
    }
    const double on_a = edges_between(points.edge_a, points.s, other.edge_a, other.s);
    const double on_b =
        points.is_of_rods() ? edges_between(points.edge_b, points.t, other.edge_b, other.t) : 0.0;
    // Where a node touches two faces, each goes on with its own.
    const double turn = 1.0 - normal.dot(anchor.normal);
    if (on_a <= 1.0 && on_b <= 1.0 && on_a + on_b + turn < nearest) {
      nearest = on_a + on_b + turn;
      found = &anchor;
    }
  }
  return found;
}

}  // namespace fiber
