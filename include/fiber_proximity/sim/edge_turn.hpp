#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "fiber_proximity/sim/rods.hpp"

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

inline EdgeDirection edge_direction(const Rods& rods, std::uint32_t edge) {
  return direction_of(rods.positions[edge + 1] - rods.positions[edge]);
}

/// The turn k = b − a from one edge's tangent a to that of the next, b. |k| = 2 sin(φ/2) for the
/// angle φ between them: unlike the 2 tan(φ/2) of Bergou et al. (2008, Eq. 1) it is finite when the
/// rod folds, and to fourth order it is nearer to φ.
class EdgeTurn {
 public:
  EdgeTurn(const EdgeDirection& before, const EdgeDirection& after)
      : before_(before), after_(after), turn_(after.tangent - before.tangent) {}

  EdgeTurn(const Rods& rods, std::uint32_t middle_node)
      : EdgeTurn(edge_direction(rods, middle_node - 1), edge_direction(rods, middle_node)) {}

  const Eigen::Vector3d& turn() const { return turn_; }
  const EdgeDirection& before() const { return before_; }
  const EdgeDirection& after() const { return after_; }

 private:
  EdgeDirection before_;
  EdgeDirection after_;
  Eigen::Vector3d turn_;
};

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

}  // namespace fiber
