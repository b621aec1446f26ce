#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "fiber_proximity/sim/rod_system.hpp"
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

/// How energies of the turn k = b − a from one edge's tangent a to that of the next, b, act on the
/// nodes. |k| = 2 sin(φ/2) for the angle φ between them: unlike the 2 tan(φ/2) of Bergou et al.
/// (2008, Eq. 1) it is finite when the rod folds, and to fourth order it is nearer to φ.
class EdgePair {
 public:
  EdgePair(const EdgeDirection& before, const EdgeDirection& after)
      : before_(before), after_(after), turn_(after.tangent - before.tangent) {}

  EdgePair(const Rods& rods, std::uint32_t middle_node)
      : EdgePair(edge_direction(rods, middle_node - 1), edge_direction(rods, middle_node)) {}

  const Eigen::Vector3d& turn() const { return turn_; }
  const EdgeDirection& before() const { return before_; }
  const EdgeDirection& after() const { return after_; }

  /// Adds the gradient of an energy whose gradients by the two tangents are known.
  /// @param middle the node between the edges, counted from the rod's first
  void add_gradient(std::uint32_t middle, const Eigen::Vector3d& by_before,
                    const Eigen::Vector3d& by_after, RodSystem& system) const {
    const Eigen::Vector3d on_before = project(before_, by_before);
    const Eigen::Vector3d on_after = project(after_, by_after);
    system.add_gradient(middle - 1, -on_before);
    system.add_gradient(middle, on_before - on_after);
    system.add_gradient(middle + 1, on_after);
  }

  /// Adds the derivatives of an energy E(k) with the gradient dE/dk, and the positive semidefinite
  /// part Jᵀ (isotropic I + along u uᵀ) J of the Hessian; J is the derivative of k.
  /// @param middle the node between the edges, counted from the rod's first
  void add_derivatives(std::uint32_t middle, const Eigen::Vector3d& gradient, double isotropic,
                       double along, const Eigen::Vector3d& u, RodSystem& system) const {
    using Eigen::Matrix3d;
    using Eigen::Vector3d;
    const Vector3d& a = before_.tangent;
    const Vector3d& b = after_.tangent;
    add_gradient(middle, -gradient, gradient, system);

    const Vector3d u_before = project(before_, u);
    const Vector3d u_after = project(after_, u);
    const Matrix3d aa = a * a.transpose();
    const Matrix3d bb = b * b.transpose();
    const Matrix3d first =
        isotropic / (before_.length * before_.length) * (Matrix3d::Identity() - aa) +
        along * u_before * u_before.transpose();
    const Matrix3d last =
        isotropic / (after_.length * after_.length) * (Matrix3d::Identity() - bb) +
        along * u_after * u_after.transpose();
    const Matrix3d cross = isotropic / (after_.length * before_.length) *
                               (Matrix3d::Identity() - aa - bb + b * (a.dot(b) * a.transpose())) +
                           along * u_after * u_before.transpose();
    system.add_hessian(middle - 1, first);
    system.add_hessian(middle, middle - 1, -first - cross);
    system.add_hessian(middle + 1, middle - 1, cross);
    system.add_hessian(middle, first + last + cross + cross.transpose());
    system.add_hessian(middle + 1, middle, -last - cross);
    system.add_hessian(middle + 1, last);
  }

 private:
  /// From a gradient by the tangent to that by the edge.
  static Eigen::Vector3d project(const EdgeDirection& edge, const Eigen::Vector3d& v) {
    return (v - edge.tangent * edge.tangent.dot(v)) / edge.length;
  }

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
