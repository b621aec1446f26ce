// Edges of rods: their directions, the turns between them, and the frames that they carry.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// An edge as length and direction.
struct EdgeDirection {
  double length;  ///< [m] never 0: an edge without length has a zero tangent
  Eigen::Vector3d tangent;
};

inline EdgeDirection direction_of(const Eigen::Vector3d& edge) {
  const double length = std::max(edge.norm(), std::numeric_limits<double>::min());
  return {length, edge / length};
}

inline EdgeDirection edge_direction(const RodState& rods, std::uint32_t edge) {
  return direction_of(rods.positions[edge + 1] - rods.positions[edge]);
}

/// Turns a vector as the shortest rotation from one unit vector to another does. Where one of them
/// is zero, as the tangent of an edge without length is, it stays as it is.
inline Eigen::Vector3d transport(const Eigen::Vector3d& v, const Eigen::Vector3d& from,
                                 const Eigen::Vector3d& to) {
  // 1 + cosine, in a form that keeps its digits where the directions are nearly opposite.
  const double beside_opposite = 0.5 * (from + to).squaredNorm();
  // Opposite directions have no shortest rotation: a vector across both keeps its direction.
  constexpr double opposite = 1e-12;
  if (beside_opposite < opposite || from.squaredNorm() * to.squaredNorm() == 0.0) {
    return v;
  }
  const Eigen::Vector3d axis = from.cross(to);
  return from.dot(to) * v + axis.cross(v) + axis * (axis.dot(v) / beside_opposite);
}

/// The director of an edge where it is now.
inline Eigen::Vector3d current_director(const Rods& rods, std::uint32_t edge) {
  return transport(rods.directors[edge], rods.start_tangents[edge],
                   edge_direction(rods, edge).tangent);
}

/// Angle from one vector to another about a unit vector across both, in (-pi, pi] [rad].
inline double signed_angle(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                           const Eigen::Vector3d& about) {
  return std::atan2(about.dot(from.cross(to)), from.dot(to));
}

/// The angle that differs by whole turns from the given one and by at most half a turn from
/// another.
inline double nearest_turn(double angle, double to) {
  const double turn = 2.0 * M_PI;
  return angle - turn * std::round((angle - to) / turn);
}

struct CosineSine {
  double cosine;
  double sine;
};

/// Cosine and sine of an angle, to some units of the last digit. The standard library's differ
/// between processors.
inline CosineSine cosine_and_sine(double angle) {
  // The series of an eighth of an angle of up to half a turn are short.
  const double eighth = 0.125 * nearest_turn(angle, 0.0);
  const double square = eighth * eighth;
  double sine = 1.0;
  double versine = 1.0;  // 1 - cosine
  for (int power = 15; power >= 3; power -= 2) {
    sine = 1.0 - sine * square / (power * (power - 1));
    versine = 1.0 - versine * square / (power * (power + 1));
  }
  sine *= eighth;
  versine *= 0.5 * square;
  for (int doubled = 0; doubled < 3; ++doubled) {
    const double half = sine;
    sine = 2.0 * half * (1.0 - versine);
    versine = 2.0 * half * half;
  }
  return {1.0 - versine, sine};
}

/// The strains of damping by the turn of cross-sections vanish towards a fold: the length of the
/// sum of both tangents, 2 cos(φ/2), by which that begins.
constexpr double fold_width = 0.5;

/// The derivative of the twist between two edges by the point after the second is this over twice
/// the second's length; by the point before the first, minus this over twice the first's
/// (Bergou et al. 2008, Eq. 9). It grows without limit where the rod folds, and is cut off there.
inline Eigen::Vector3d curvature_binormal(const Eigen::Vector3d& tangent_before,
                                          const Eigen::Vector3d& tangent_after) {
  constexpr double folded = 1e-3;
  return 2.0 * tangent_before.cross(tangent_after) /
         std::max(folded, 1.0 + tangent_before.dot(tangent_after));
}

/// The derivative, by the edge's second point, of the angle by which current_director() turns about
/// the tangent; by the first point it is minus this. The director is transported in one rotation
/// from where the step began, which differs from transport bit by bit.
inline Eigen::Vector3d director_turn(const Eigen::Vector3d& start_tangent,
                                     const EdgeDirection& edge) {
  return curvature_binormal(start_tangent, edge.tangent) / (-2.0 * edge.length);
}

/// One rod of a pack, for computations rod by rod. Nodes and edges are counted from the rod's first
/// one.
class PackLane {
 public:
  PackLane(const RodPack& rods, std::size_t lane) : rods_(rods), lane_(lane) {}

  std::size_t lane() const { return lane_; }
  std::uint32_t node_count() const { return rods_.node_count; }
  bool has_twist() const { return rods_.unknowns == 4; }
  /// The stiffness of an edge, and of the length at rest that belongs to a node.
  double stretching_stiffness(std::uint32_t edge) const {
    return rods_.stretching_stiffness[lane_] *
           section_share(rods_.inverse_stretching_lengths, edge, rest_length(edge));
  }
  double bending_stiffness(std::uint32_t node) const {
    return rods_.bending_stiffness[lane_] *
           section_share(rods_.inverse_bending_lengths, node, rest_length_at(node));
  }
  double twisting_stiffness(std::uint32_t node) const {
    return rods_.twisting_stiffness[lane_] *
           section_share(rods_.inverse_twisting_lengths, node, rest_length_at(node));
  }
  /// Half of each edge at the node [m].
  double rest_length_at(std::uint32_t node) const {
    return 0.5 * ((node > 0 ? rest_length(node - 1) : 0.0) +
                  (node + 1 < rods_.node_count ? rest_length(node) : 0.0));
  }
  double rest_length(std::uint32_t edge) const { return rods_.rest_lengths[edge][lane_]; }
  Eigen::Vector3d position(std::uint32_t node) const {
    return vector(rods_.positions, rods_.unknowns * node);
  }
  EdgeDirection direction(std::uint32_t edge) const {
    return {rods_.lengths[edge][lane_], vector(rods_.tangents, std::size_t{3} * edge)};
  }

  /// With twist only.
  double angle(std::uint32_t edge) const {
    return rods_.positions[std::size_t{4} * edge + 3][lane_];
  }
  Eigen::Vector3d director(std::uint32_t edge) const {
    return vector(rods_.directors, std::size_t{3} * edge);
  }
  Eigen::Vector3d start_tangent(std::uint32_t edge) const {
    return vector(rods_.start_tangents, std::size_t{3} * edge);
  }

 private:
  /// The part of the rod's own stiffness that a section has.
  double section_share(const std::vector<SimdBatch>& inverse_lengths, std::uint32_t at,
                       double length) const {
    return rods_.has_sections ? length * inverse_lengths[at][lane_] : 1.0;
  }
  Eigen::Vector3d vector(const std::vector<SimdBatch>& from, std::size_t first) const {
    return {from[first][lane_], from[first + 1][lane_], from[first + 2][lane_]};
  }

  const RodPack& rods_;
  std::size_t lane_;
};

/// Calls function(rod, edge, its index in Rods) for all edges of the rods of a pack.
template <class Function>
void for_each_edge(const RodPack& rods, const Function& function) {
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    for (std::uint32_t edge = 0; edge + 1 < rods.node_count; ++edge) {
      function(PackLane(rods, lane), edge, rods.first_nodes[lane] + edge);
    }
  }
}

}  // namespace fiber
