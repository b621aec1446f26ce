#pragma once

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

// Operations of a step on rods side by side, in all lanes at once.

/// Updates lengths, tangents and, with twist, directors of the edges where the rods are now.
void measure_edges(RodPack& rods);

/// The size of arrays: the number of SimdBatches, and of the lanes in use.
struct SumSize {
  std::size_t count;
  std::size_t used;
};

/// Σ inertia · (position − predicted)², by lane.
SimdBatch weighted_squares(SumSize size, const SimdBatch* inertias, const SimdBatch* positions,
                           const SimdBatch* predicted);

/// Writes factor · inertia · (position − predicted) as gradient, and factor · inertia on the
/// diagonal of a Hessian, whose columns are so high.
void set_inertia(SumSize size, double factor, const SimdBatch* inertias, const SimdBatch* positions,
                 const SimdBatch* predicted, SimdBatch* gradient, SimdBatch* hessian,
                 std::size_t height);

/// Σ a · b, by lane.
SimdBatch dot_products(SumSize size, const SimdBatch* a, const SimdBatch* b);

/// sum = from + share · step; where the share of a lane is 0, the sum is `from` even for a step
/// that is not finite. The arrays may be the same.
void add_scaled(SumSize size, const SimdBatch* from, const SimdBatch* step, const SimdBatch& shares,
                SimdBatch* sum);

/// Writes, for each node, the squared norm of the scaled gradient by its position, or the square of
/// that by its angle if it is larger.
void squared_residuals(SumSize size, std::size_t unknowns, const SimdBatch* gradient,
                       const SimdBatch* scales, SimdBatch* squares);

/// Replaces positive definite Hessians by factors L D Lᵀ, with the inverse of D on the diagonal.
/// Needs no pivoting. LAPACK's pbtrf does the same for one matrix, but works in calls per column,
/// each of which takes longer than a column of this width.
///
/// A pivot that is not positive, as rounding errors may leave it where stiffnesses differ by more
/// digits than a double has, is replaced by the largest number: the solution there is about 0, and
/// the factors are those of a positive definite matrix.
void factorise_band(PackSystem& system);

/// Solves equations with the factors.
/// @param values as many as the gradient has, right-hand sides and then the solutions; at least
///               half_bandwidth() zeros follow them
void solve_band(const PackSystem& system, SimdBatch* values);

}  // namespace fiber
