#pragma once

#include "fiber_proximity/sim/pack_system.hpp"

namespace fiber {

/// Replaces positive definite Hessians by factors L D Lᵀ, with the inverse of D on the diagonal.
/// Needs no pivoting. LAPACK's pbtrf does the same for one matrix, but works in calls per column,
/// each of which takes longer than a column of this width.
///
/// An unknown whose pivot is not positive, as rounding errors may leave it where stiffnesses differ
/// by more digits than numbers have, becomes as stiff as can be: its solution is about 0, and the
/// factors are those of a positive definite matrix.
void factorise_band(PackSystem& system);

/// Solves equations with the factors.
/// @param values as many as the gradient has, right-hand sides and then the solutions; at least
///               half_bandwidth() zeros follow them
void solve_band(const PackSystem& system, SimdBatch* values);

}  // namespace fiber
