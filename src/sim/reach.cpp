#include "src/sim/reach.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fiber {

using Eigen::Vector3d;

namespace {

/// The largest share of a way from inside of a sphere, or from its surface, that stays inside.
double share_inside(const Vector3d& from, const Vector3d& way, double radius) {
  // |from + s way|² = radius²: the larger solution
  const double a = way.squaredNorm();
  const double b = from.dot(way);
  const double c = from.squaredNorm() - radius * radius;
  if (!(a > 0.0)) {
    return 1.0;
  }
  const double root = std::sqrt(std::max(0.0, b * b - a * c));
  const double share = b > 0.0 ? std::max(0.0, -c) / (b + root) : (root - b) / a;
  return std::clamp(share, 0.0, 1.0);
}

}  // namespace

double rest_length_between(const Rods& rods, std::uint32_t rod, std::uint32_t node,
                           std::uint32_t other) {
  const auto edges = rods.rest_lengths.begin() + rods.first(rod);
  const auto [first, last] = std::minmax(node, other);
  return std::accumulate(edges + first, edges + last, 0.0);
}

double rest_length(const Rods& rods, std::uint32_t rod) {
  return rest_length_between(rods, rod, 0, rods.node_count(rod) - 1);
}

std::vector<ReachLimit> reach_limits(const Rods& rods, const Attachment& attachment,
                                     std::uint32_t rod, std::uint32_t node, double time,
                                     double strain) {
  std::vector<ReachLimit> limits;
  for (const HeldNode& held : attachment.held_at(rod, time)) {
    if (held.node != node) {
      const double length = rest_length_between(rods, rod, node, held.node);
      limits.push_back({held.node, held.position, length, (1.0 + strain) * length});
    }
  }
  return limits;
}

double reachable_share(const std::vector<ReachLimit>& limits, const Vector3d& from,
                       const Vector3d& to) {
  double share = 1.0;
  for (const ReachLimit& limit : limits) {
    if (!limit.allows(to)) {
      const Vector3d start = from - limit.center;
      share = std::min(share, share_inside(start, to - from, std::max(limit.radius, start.norm())));
    }
  }
  return share;
}

double pull_speed(const RodSection& section, double strain) {
  return strain * std::sqrt(section.stretching_stiffness / section.mass_per_length);
}

LargestStrain largest_strain(const Rods& rods) {
  LargestStrain largest;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const double length = (rods.positions[i + 1] - rods.positions[i]).norm();
      const double strain = length / rods.rest_lengths[i] - 1.0;
      if (strain > largest.strain) {
        largest = {strain, rod, i - rods.first(rod)};
      }
    }
  }
  return largest;
}

}  // namespace fiber
