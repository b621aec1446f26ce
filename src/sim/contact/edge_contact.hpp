#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/sim/contact/barrier.hpp"

namespace fiber {

/// Edges of one rod whose indices differ by at most this are never in contact: they meet at a node.
constexpr std::uint32_t contact_neighbour_skip = 1;

/// Edges with less of the rod between them than this, measured at rest, are never in contact
/// either: twice the sum of their radii, four radii of a rod that is as thick all along [m]. A rod
/// that turns back in a half-circle of that length has 2.5 radii between its axes, and does not
/// touch itself: however long its edges are, a contact needs a sharper bend or a loop.
inline double contact_neighbour_length(const Rods& rods, std::uint32_t rod_a, std::uint32_t edge_a,
                                       std::uint32_t rod_b, std::uint32_t edge_b) {
  return 2.0 * (rods.edge_radius(rod_a, edge_a) + rods.edge_radius(rod_b, edge_b));
}

/// Whether two edges of one rod are too near each other along it to be in contact.
/// @param arcs arc length at rest from the rod's first node, by node [m]
inline bool are_contact_neighbours(const Rods& rods, const std::vector<double>& arcs,
                                   std::uint32_t rod, std::uint32_t edge_a, std::uint32_t edge_b) {
  const std::uint32_t first = edge_a < edge_b ? edge_a : edge_b;
  const std::uint32_t last = edge_a < edge_b ? edge_b : edge_a;
  return last - first <= contact_neighbour_skip ||
         arcs[last] - arcs[first + 1] < contact_neighbour_length(rods, rod, first, rod, last);
}

/// Arc lengths at rest of all nodes from their rod's first one [m].
inline std::vector<double> contact_arcs(const Rods& rods) {
  std::vector<double> arcs(rods.positions.size(), 0.0);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      arcs[i + 1] = arcs[i] + rods.rest_lengths[i];
    }
  }
  return arcs;
}

/// Two edges that may touch.
struct EdgePair {
  std::uint32_t rod_a;
  std::uint32_t edge_a;  ///< as Rods counts edges
  std::uint32_t rod_b;
  std::uint32_t edge_b;
  Barrier barrier;
  double restitution;  ///< of impacts, in [0, 1]

  /// For each of the four ends (two of a, two of b): whether the contact of this node and the other
  /// edge belongs to this pair, and not to that of the neighbouring edge at the node.
  std::array<bool, 4> owns{};

  /// For each of them: whether the edges before and after the other edge may touch the node, too.
  std::array<std::array<bool, 2>, 4> has_neighbour{};
};

/// A part of a contact's energy that depends on one distance: of a point of an edge a and a point
/// of an edge b.
struct DistanceTerm {
  double s;                ///< curve parameter on a, in [0, 1]
  double t;                ///< curve parameter on b
  Eigen::Vector3d normal;  ///< unit vector from b to a
  double slope;            ///< of the energy by the distance [N]

  /// A positive part of the second derivative; of a term that is coupled with others, that by all
  /// their distances alike [N/m].
  double curvature;

  /// The normal force, at least 0 [N]. It is not all of the slope: a part of that moves weight from
  /// one contact of two edges to another.
  double pressure;

  /// Stiffness against a rotation that brings one end of edge a nearer than the other, which moves
  /// the nearest point along the edge [N/m].
  double turning = 0.0;

  /// Stiffness against a displacement across the normal, where the two attract each other [N/m].
  double across = 0.0;

  /// The part of another term's curvature, of the same distance, that the coupling has in it [N/m].
  double borrowed = 0.0;
};

/// The terms of one contact: two edges have no more than that of their own distance and, for each
/// end, that of its distance and those of two corners. The distance of the edges and those of the
/// ends may be coupled.
class DistanceTerms {
 public:
  static constexpr int max_coupled = 5;
  using Parts = std::array<double, max_coupled>;

  void push_back(const DistanceTerm& term) {
    assert(count_ < terms_.size());
    terms_[count_++] = term;
  }
  void clear() {
    count_ = 0;
    coupled_count_ = 0;
  }
  const DistanceTerm* begin() const { return terms_.data(); }
  const DistanceTerm* end() const { return terms_.data() + count_; }

  /// Couples the next terms to be pushed, as many as rows: these are the second derivatives of the
  /// energy by their distances together.
  template <class Square>
  void couple(const Square& hessian) {
    first_coupled_ = count_;
    coupled_count_ = static_cast<std::size_t>(hessian.rows());
    hessian_.topLeftCorner<Square::RowsAtCompileTime, Square::RowsAtCompileTime>() = hessian;
  }

  bool is_coupled(const DistanceTerm& term) const {
    const auto index = static_cast<std::size_t>(&term - terms_.data());
    return index >= first_coupled_ && index < first_coupled_ + coupled_count_;
  }

  /// Calls function(parts) for vectors g whose sum of g gᵀ is the positive part of these second
  /// derivatives: parts[i] is that of the term first_coupled() + i.
  template <class Function>
  void for_each_coupling(const Function& function) const {
    if (coupled_count_ == 0) {
      return;
    }
    std::array<Eigen::Index, max_coupled> rows{};  // those that are not zero
    Eigen::Index count = 0;
    for (std::size_t i = 0; i < coupled_count_; ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      if (hessian_(row, row) != 0.0) {
        rows[static_cast<std::size_t>(count++)] = row;
      }
    }
    Square matrix(count, count);
    for (Eigen::Index row = 0; row < count; ++row) {
      for (Eigen::Index column = 0; column < count; ++column) {
        matrix(row, column) =
            hessian_(rows[static_cast<std::size_t>(row)], rows[static_cast<std::size_t>(column)]);
      }
    }
    const Square root = root_of_positive_part(matrix);
    for (Eigen::Index column = 0; column < count; ++column) {
      Parts parts{};
      for (Eigen::Index row = 0; row < count; ++row) {
        parts[static_cast<std::size_t>(rows[static_cast<std::size_t>(row)])] = root(row, column);
      }
      if (root.col(column).squaredNorm() > 0.0) {
        function(parts);
      }
    }
  }
  const DistanceTerm* first_coupled() const { return terms_.data() + first_coupled_; }
  std::size_t coupled_count() const { return coupled_count_; }

 private:
  using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, max_coupled, max_coupled>;

  /// A matrix whose product with its own transpose is the positive part of a symmetric one.
  static Square root_of_positive_part(const Square& matrix) {
    // A positive one needs no eigenvectors, and this takes a tenth of their time.
    const Eigen::LLT<Square> cholesky(matrix);
    if (cholesky.info() == Eigen::Success) {
      return cholesky.matrixL();
    }
    const Eigen::SelfAdjointEigenSolver<Square> solver(matrix);
    return solver.eigenvectors() *
           solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().eval().asDiagonal();
  }

  std::array<DistanceTerm, 13> terms_;
  std::size_t count_ = 0;
  Eigen::Matrix<double, max_coupled, max_coupled> hessian_;
  std::size_t first_coupled_ = 0;
  std::size_t coupled_count_ = 0;
};

/// The potential of two polylines near each other, edge by edge:
///
/// - Each node has the barrier of its distance from the other polyline: the sum over that one's
///   edges, less the sum over the nodes between two of them, which both edges have (Li et al. 2023,
///   Sect. 4). So the force on a node that slides along another rod does not jump from edge to
///   edge.
/// - Two edges that cross have the barrier of their distance times a weight: 0 where one of their
///   ends is as near to the other edge as they are to each other, as where they lie side by side or
///   meet at a node, and 1 where all ends are too far away to have a barrier of their own. The
///   nearest points of parallel edges jump along them, this energy does not. With less weight the
///   barrier begins nearer, so that the contacts of the ends carry the load, not one of little
///   weight.
///
/// Gradients are exact, in terms of distances.
/// @param nearest of the two edges, where `positions` has them
/// @param terms   appended to; null if only the energy is asked for
/// @returns energy [J], infinite where a distance has reached its least value
double edge_contact(const EdgePair& pair, const std::vector<Eigen::Vector3d>& positions,
                    const SegmentDistance& nearest, DistanceTerms* terms);

}  // namespace fiber
