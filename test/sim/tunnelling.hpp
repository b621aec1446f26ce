#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "fiber_proximity/sim/rods.hpp"
#include "test/sim/solver_path.hpp"

namespace fiber::test {

/// An edge as it moves in a straight line during a step: its ends before and after [m].
struct MovingEdge {
  std::array<Eigen::Vector3d, 2> before;
  std::array<Eigen::Vector3d, 2> after;

  Eigen::Vector3d at(int end, double time) const {
    return (1.0 - time) * before[end] + time * after[end];
  }
  Eigen::AlignedBox3d box() const {
    Eigen::AlignedBox3d box(before[0]);
    return box.extend(before[1]).extend(after[0]).extend(after[1]);
  }
};

/// Distance of a point from a segment.
inline double point_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                            const Eigen::Vector3d& b) {
  const double length = (b - a).squaredNorm();
  const double s = length > 0.0 ? std::clamp((p - a).dot(b - a) / length, 0.0, 1.0) : 0.0;
  return (a + s * (b - a) - p).norm();
}

/// Distance of two segments: of their ends from the other, or between inner points of both, where
/// it is along the normal of both.
inline double edge_distance(const Eigen::Vector3d& a0, const Eigen::Vector3d& a1,
                            const Eigen::Vector3d& b0, const Eigen::Vector3d& b1) {
  double distance = std::min({point_segment(a0, b0, b1), point_segment(a1, b0, b1),
                              point_segment(b0, a0, a1), point_segment(b1, a0, a1)});
  const Eigen::Vector3d normal = (a1 - a0).cross(b1 - b0);
  // Where they are parallel but for rounding the normal points anywhere, and an end is as near.
  constexpr double parallel = 1e-9;
  if (normal.norm() > parallel * (a1 - a0).norm() * (b1 - b0).norm()) {
    // Each crosses the plane that holds the other and the normal.
    const auto crosses = [&](const Eigen::Vector3d& p, const Eigen::Vector3d& along,
                             const Eigen::Vector3d& r0, const Eigen::Vector3d& r1) {
      const Eigen::Vector3d across = along.cross(normal);
      return across.dot(r0 - p) * across.dot(r1 - p) <= 0.0;
    };
    if (crosses(a0, a1 - a0, b0, b1) && crosses(b0, b1 - b0, a0, a1)) {
      distance = std::min(distance, std::abs(normal.normalized().dot(b0 - a0)));
    }
  }
  return distance;
}

/// Whether two edges meet while they move: conservative advancement, by no more than what is
/// between them at the speed of the fastest pair of ends. Written apart from what it checks.
inline bool meet(const MovingEdge& a, const MovingEdge& b) {
  if (!a.box().intersects(b.box())) {
    return false;
  }
  double fastest = 0.0;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      fastest = std::max(fastest, (a.after[i] - a.before[i] - b.after[j] + b.before[j]).norm());
    }
  }
  const double nothing = 1e-9 * (a.box().diagonal().norm() + b.box().diagonal().norm());
  for (double time = 0.0; time <= 1.0;) {
    const double distance =
        edge_distance(a.at(0, time), a.at(1, time), b.at(0, time), b.at(1, time));
    if (distance <= nothing) {
      return true;
    }
    if (distance >= fastest * (1.0 - time)) {
      return false;
    }
    time += distance / fastest;
  }
  return false;
}

/// On one rod and within what self-contact leaves out.
inline bool are_near(const Rods& rods, std::uint32_t i, std::uint32_t j) {
  double between = 0.0;
  for (std::uint32_t k = i + 1; k <= j; ++k) {
    if (rods.rest_lengths[k - 1] == 0.0) {
      return false;  // the end of a rod
    }
    between += k < j ? rods.rest_lengths[k] : 0.0;
  }
  const double largest = *std::max_element(rods.radii.begin(), rods.radii.end());
  return j - i <= 2 || between < 4.0 * largest;
}

/// Looks whether axes of rods meet, from one call to the next.
class TunnellingChecker {
 public:
  explicit TunnellingChecker(const Rods& rods) : before_(rods.positions) {}

  /// On the straight way since the last call.
  /// @returns the first pair of edges that met; empty if none did
  std::string check(const Rods& rods) {
    std::string met = find(rods, [&](std::uint32_t i, std::uint32_t j) {
      const auto edge = [&](std::uint32_t first) {
        return MovingEdge{{before_[first], before_[first + 1]},
                          {rods.positions[first], rods.positions[first + 1]}};
      };
      return meet(edge(i), edge(j));
    });
    before_ = rods.positions;
    return met;
  }

  /// On the way that the solver went in the last step: with long steps, things come, go and slide
  /// within one.
  static std::string check(const Rods& rods, const SolverPath& path) {
    return find(rods, [&](std::uint32_t i, std::uint32_t j) {
      const std::uint32_t rod_i = rod_of(rods, i);
      const std::uint32_t rod_j = rod_of(rods, j);
      const std::size_t pieces = path.pieces(rod_i, rod_j);
      for (std::size_t piece = 0; piece < pieces; ++piece) {
        if (meet(moving(path, rod_i, i, piece, pieces), moving(path, rod_j, j, piece, pieces))) {
          return true;
        }
      }
      return false;
    });
  }

  /// Whether rods have passed through an edge that does not move.
  static bool passes(const Rods& rods, const SolverPath& path, const Eigen::Vector3d& b0,
                     const Eigen::Vector3d& b1) {
    for (std::uint32_t i = 0; i < rods.positions.size(); ++i) {
      if (rods.rest_lengths[i] == 0.0) {
        continue;
      }
      const std::uint32_t rod = rod_of(rods, i);
      const std::size_t pieces = path.pieces(rod, rod);
      for (std::size_t piece = 0; piece < pieces; ++piece) {
        if (meet(moving(path, rod, i, piece, pieces), {{b0, b1}, {b0, b1}})) {
          return true;
        }
      }
    }
    return false;
  }

 private:
  /// The first pair of edges of which something is true.
  template <class Pair>
  static std::string find(const Rods& rods, const Pair& is_true) {
    for (std::uint32_t i = 0; i < rods.positions.size(); ++i) {
      if (rods.rest_lengths[i] == 0.0) {
        continue;
      }
      // Neighbours share a node, and those of one rod two edges away may touch by folding.
      for (std::uint32_t j = i + 1; j < rods.positions.size(); ++j) {
        if (rods.rest_lengths[j] > 0.0 && !are_near(rods, i, j) && is_true(i, j)) {
          return "edges " + std::to_string(i) + " and " + std::to_string(j);
        }
      }
    }
    return "";
  }

  static std::uint32_t rod_of(const Rods& rods, std::uint32_t node) {
    std::uint32_t rod = 0;
    while (node >= rods.end(rod)) {
      ++rod;
    }
    return rod;
  }

  static MovingEdge moving(const SolverPath& path, std::uint32_t rod, std::uint32_t edge,
                           std::size_t piece, std::size_t pieces) {
    const auto at = [&](std::uint32_t node, std::size_t when) {
      return path.position(rod, node, when, pieces);
    };
    return {{at(edge, piece), at(edge + 1, piece)}, {at(edge, piece + 1), at(edge + 1, piece + 1)}};
  }

  std::vector<Eigen::Vector3d> before_;
};

}  // namespace fiber::test
