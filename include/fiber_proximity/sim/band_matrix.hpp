#pragma once

#include <cstddef>
#include <vector>

namespace fiber {

/// A symmetric positive definite matrix with all entries near the diagonal, as one rod makes it:
/// what is unknown at a node meets only what is unknown at this node and the next two.
///
/// Factorised without pivoting, which needs none for such a matrix. LAPACK's pbtrf does the same,
/// but works in calls per column, each of which takes longer than a column of this width.
class BandMatrix {
 public:
  /// Half-bandwidths of a rod: three unknowns a node, or four where an edge can twist.
  static constexpr std::size_t without_twist = 8;
  static constexpr std::size_t with_twist = 10;

  /// A zero matrix.
  /// @param half_bandwidth without_twist or with_twist: how far off the diagonal entries may be
  BandMatrix(std::size_t size, std::size_t half_bandwidth);

  std::size_t size() const { return size_; }
  std::size_t half_bandwidth() const { return half_bandwidth_; }

  /// An entry on or below the diagonal, column <= row <= column + half_bandwidth.
  double& at(std::size_t row, std::size_t column) {
    return entries_[column * (half_bandwidth_ + 1) + (row - column)];
  }
  double at(std::size_t row, std::size_t column) const {
    return entries_[column * (half_bandwidth_ + 1) + (row - column)];
  }

  /// All entries, column by column from the diagonal down.
  double* data() { return entries_.data(); }

  void set_zero();

  /// Row and column become those of the identity: the unknown is known to be its right-hand side.
  void decouple(std::size_t index);

  /// Replaces the matrix by its factors L D Lᵀ. An unknown whose pivot is not positive, as rounding
  /// errors may leave it where stiffnesses differ by more digits than numbers have, becomes as
  /// stiff as can be: its solution is about 0, and the factors are those of a positive definite
  /// matrix.
  /// @returns false if there was such an unknown
  bool factorise();

  /// @param values size() values: the right-hand side, then the solution; the matrix is factorised
  void solve(double* values) const;

 private:
  std::size_t size_;
  std::size_t half_bandwidth_;
  std::vector<double> entries_;  // column by column, from the diagonal down; zero columns follow
};

/// BandMatrix::decouple() of a matrix with other ones' entries between its own.
/// @param entries column by column from the diagonal down
/// @param stride  from one entry to the next
void decouple(std::size_t index, std::size_t half_bandwidth, std::size_t stride, double* entries);

}  // namespace fiber
