#pragma once

#include "fiber_proximity/sim/rod_lanes.hpp"

namespace fiber {

/// Lengths and tangents of the edges of rods side by side.
void measure_edges(RodLanes& rods);

/// BandMatrix::factorise() of matrices side by side.
/// @param hessian columns of 9 from the diagonal down, and at least 8 columns of zeros after them
/// @param size    of each matrix
void factorise_lanes(std::size_t size, std::vector<Lanes>& hessian);

/// BandMatrix::solve() of matrices side by side.
/// @param values right-hand sides and at least 8 zeros after them; then the solutions
void solve_lanes(std::size_t size, const std::vector<Lanes>& hessian, std::vector<Lanes>& values);

}  // namespace fiber
