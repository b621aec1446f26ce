#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include "src/sim/contact/contact_neighbours.hpp"
#include "src/sim/edges.hpp"
#include "src/sim/joint/unite_joints.hpp"
#include "src/sim/overlaps.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Neighbouring overlaps of the same two things, which are separated along one direction.
using Patch = std::vector<Overlap>;

/// One side of an overlap: an edge of a rod, and how its nodes take part.
struct Side {
  std::uint32_t rod;
  std::uint32_t edge;  // counted through all rods
  double parameter;
  double width;     // [m] of rod on both sides of the edge that moves with it
  double mobility;  // of the point: 0 where it is held
};

/// Factor on the distance to which surfaces are separated, for rounding errors.
constexpr double clearance = 1.0 + 1e-4;

/// Length of rod, on both sides of where it is moved, that moves with it, in radii.
constexpr double spread = 20.0;

class Separation {
 public:
  /// Near a held node a rod moves less.
  Separation(Rods& rods, const std::vector<bool>& is_held)
      : rods_(rods), mobilities_(rods.positions.size(), 1.0) {
    for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
      const double width = spread * rods_.radii[rod];
      double since = std::numeric_limits<double>::infinity();
      const auto visit = [&](std::uint32_t node, double edge) {
        since = is_held[node] ? 0.0 : since + edge;
        mobilities_[node] = std::min(mobilities_[node], since / width);
      };
      for (std::uint32_t i = rods_.first(rod); i < rods_.end(rod); ++i) {
        visit(i, i > rods_.first(rod) ? rods_.rest_lengths[i - 1] : 0.0);
      }
      since = std::numeric_limits<double>::infinity();
      for (std::uint32_t i = rods_.end(rod); i-- > rods_.first(rod);) {
        visit(i, rods_.rest_lengths[i]);
      }
    }
  }

  void separate(const Patch& patch) {
    const Vector3d direction = direction_of(patch);
    for (const Overlap& overlap : patch) {
      if (overlap.is_object) {
        leave_object(overlap, direction);
      } else {
        separate_rods(overlap, direction);
      }
    }
  }

 private:
  Side side_of(std::uint32_t rod, std::uint32_t edge, double parameter, double width) const {
    const std::uint32_t first = rods_.first(rod) + edge;
    const double mobility =
        (1.0 - parameter) * mobilities_[first] + parameter * mobilities_[first + 1];
    constexpr double min_mobility = 1e-3;
    return {rod, first, parameter, width, mobility < min_mobility ? 0.0 : mobility};
  }

  /// Edges of one rod do not move each other's neighbourhood.
  double width_of(const Overlap& overlap) const {
    const Contact& contact = overlap.contact;
    const double radius = overlap.is_object
                              ? radius_of(rods_, contact.fiber_a, contact.segment_a)
                              : std::max(radius_of(rods_, contact.fiber_a, contact.segment_a),
                                         radius_of(rods_, contact.fiber_b, contact.segment_b));
    if (overlap.is_object || contact.fiber_a != contact.fiber_b) {
      return spread * radius;
    }
    const auto [first, last] = std::minmax(contact.segment_a, contact.segment_b);
    constexpr double share = 0.45;
    const auto edges = rods_.rest_lengths.begin() + rods_.first(contact.fiber_a);
    const double between = std::accumulate(edges + first + 1, edges + last, 0.0);
    return std::min(spread * radius, share * between);
  }

  Vector3d point_of(const Side& side) const {
    return (1.0 - side.parameter) * rods_.positions[side.edge] +
           side.parameter * rods_.positions[side.edge + 1];
  }

  /// Moves the point of a side by a displacement, and its neighbourhood with it.
  void move(const Side& side, const Vector3d& displacement) {
    constexpr double largest_lever = 3.0;
    const auto move_node = [&](std::uint32_t node, double away) {
      const double part = away < side.width ? 1.0 - std::pow(away / side.width, 2) : 0.0;
      const double lever = std::min(largest_lever, mobilities_[node] / side.mobility);
      rods_.positions[node] += part * part * lever * displacement;
    };
    move_node(side.edge, 0.0);
    move_node(side.edge + 1, 0.0);
    double away = 0.0;
    for (std::uint32_t i = side.edge; i > rods_.first(side.rod) && away < side.width; --i) {
      away += rods_.rest_lengths[i - 1];
      move_node(i - 1, away);
    }
    away = 0.0;
    for (std::uint32_t i = side.edge + 2; i < rods_.end(side.rod) && away < side.width; ++i) {
      away += rods_.rest_lengths[i - 1];
      move_node(i, away);
    }
  }

  /// The direction of the deepest overlap, from b to a.
  Vector3d direction_of(const Patch& patch) const {
    const Overlap& deepest = patch.front();
    const Contact& contact = deepest.contact;
    if (deepest.is_object) {
      return -contact.normal;
    }
    const Vector3d between = point_of(side_of(contact.fiber_a, contact.segment_a, contact.s, 0.0)) -
                             point_of(side_of(contact.fiber_b, contact.segment_b, contact.t, 0.0));
    constexpr double same = 1e-6;
    const double touching = touching_distance(rods_, contact);
    return between.norm() > same * touching ? between.normalized() : choose_direction(patch);
  }

  /// For axes that meet: the one of some directions that is most across all edges of the patch.
  Vector3d choose_direction(const Patch& patch) const {
    std::vector<Vector3d> tangents;
    Vector3d mean = Vector3d::Zero();
    for (const Overlap& overlap : patch) {
      const Contact& contact = overlap.contact;
      for (const std::uint32_t edge : {rods_.first(contact.fiber_a) + contact.segment_a,
                                       rods_.first(contact.fiber_b) + contact.segment_b}) {
        tangents.push_back(edge_direction(rods_, edge).tangent);
        mean += mean.dot(tangents.back()) < 0.0 ? -tangents.back() : tangents.back();
      }
    }
    mean.normalize();
    const Vector3d across = tangents[0].cross(tangents[1]);
    std::vector<Vector3d> directions;
    constexpr double parallel = 1e-3;
    if (across.norm() > parallel) {
      directions.push_back(across.normalized());
    }
    for (const int k : {2, 1, 0}) {
      const Vector3d axis = Vector3d::Unit(k);
      const Vector3d rest = axis - mean * mean.dot(axis);
      if (rest.norm() > 0.5) {
        directions.push_back(rest.normalized());
      }
    }
    const auto along = [&tangents](const Vector3d& direction) {
      double sum = 0.0;
      for (const Vector3d& tangent : tangents) {
        sum += std::pow(direction.dot(tangent), 2);
      }
      return sum;
    };
    Vector3d best = directions.front();
    for (const Vector3d& direction : directions) {
      constexpr double better = 1e-6;
      best = along(direction) < along(best) - better * static_cast<double>(patch.size()) ? direction
                                                                                         : best;
    }
    return best;
  }

  void separate_rods(const Overlap& overlap, const Vector3d& direction) {
    const Contact& contact = overlap.contact;
    const double width = width_of(overlap);
    const Side a = side_of(contact.fiber_a, contact.segment_a, contact.s, width);
    const Side b = side_of(contact.fiber_b, contact.segment_b, contact.t, width);
    const double wanted = clearance * touching_distance(rods_, contact);
    const Vector3d between = point_of(a) - point_of(b);
    const double missing_square = wanted * wanted - between.squaredNorm();
    const double mobility = a.mobility + b.mobility;
    if (!(missing_square > 0.0) || mobility == 0.0) {
      return;
    }
    // |between + way · direction| = wanted
    const double along = between.dot(direction);
    const double way = std::sqrt(missing_square + along * along) - along;
    if (a.mobility > 0.0) {
      move(a, a.mobility / mobility * way * direction);
    }
    if (b.mobility > 0.0) {
      move(b, -b.mobility / mobility * way * direction);
    }
  }

  /// The depth is that when it was found, less the motion for other overlaps of the patch.
  void leave_object(const Overlap& overlap, const Vector3d& direction) {
    const Contact& contact = overlap.contact;
    const Side side = side_of(contact.fiber_a, contact.segment_a, contact.s, width_of(overlap));
    const Vector3d out = -contact.normal;
    const Vector3d& surface = contact.point_b;  // of the object
    const double wanted = clearance * radius_of(rods_, contact.fiber_a, contact.segment_a);
    const double missing = wanted - out.dot(point_of(side) - surface);
    // Overlaps that are nearer to another side move with the rest of the patch.
    constexpr double steepest = 0.5;
    if (missing > 0.0 && side.mobility > 0.0 && direction.dot(out) > steepest) {
      move(side, missing * direction);
    }
  }

  Rods& rods_;
  std::vector<double> mobilities_;  // by node, in [0, 1]
};

/// @param overlaps the deepest first
/// @returns patches in the order of their deepest overlaps
std::vector<Patch> patches_of(const std::vector<Overlap>& overlaps) {
  using Key = std::tuple<bool, std::uint32_t, std::uint32_t, std::int64_t, std::int64_t>;
  const auto key_of = [](const Overlap& overlap, std::int64_t shift_a, std::int64_t shift_b) {
    const Contact& contact = overlap.contact;
    return Key{overlap.is_object, contact.fiber_a, contact.fiber_b, contact.segment_a + shift_a,
               overlap.is_object ? 0 : contact.segment_b + shift_b};
  };
  std::map<Key, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < overlaps.size(); ++i) {
    places[key_of(overlaps[i], 0, 0)].push_back(i);
  }
  std::vector<Patch> patches;
  for (const Overlap& first : overlaps) {
    std::vector<std::size_t> members;
    const auto take = [&](const Key& key) {
      if (const auto place = places.extract(key)) {
        members.insert(members.end(), place.mapped().begin(), place.mapped().end());
      }
    };
    take(key_of(first, 0, 0));
    // It grows meanwhile. NOLINTNEXTLINE(modernize-loop-convert)
    for (std::size_t next = 0; next < members.size(); ++next) {
      for (std::int64_t a = -1; a <= 1; ++a) {
        for (std::int64_t b = -1; b <= 1; ++b) {
          take(key_of(overlaps[members[next]], a, b));
        }
      }
    }
    if (members.empty()) {  // it is in a patch already
      continue;
    }
    std::sort(members.begin(), members.end());
    patches.emplace_back();
    for (const std::size_t member : members) {
      patches.back().push_back(overlaps[member]);
    }
  }
  return patches;
}

}  // namespace

std::vector<Overlap> separate_overlaps(Rods& rods, OverlapFinder& finder,
                                       const std::vector<bool>& is_held) {
  constexpr int max_rounds = 300;
  constexpr std::uint32_t max_at_once = 100000;
  constexpr double settled = 0.1 * touching_share;
  Separation separation(rods, is_held);
  for (int round = 0; round < max_rounds; ++round) {
    const std::vector<Overlap> overlaps = finder.find(rods, settled, max_at_once);
    if (overlaps.empty()) {
      return {};
    }
    for (const Patch& patch : patches_of(overlaps)) {
      separation.separate(patch);
    }
    unite_joints(rods, is_held);
  }
  return finder.find(rods, touching_share, max_at_once);
}

}  // namespace fiber
