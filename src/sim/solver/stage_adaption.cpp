// A solve adapts the rods' travel bounds for the next one.

#include <algorithm>
#include <cmath>

#include "src/sim/solver/stage_solver.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// A rod's travel bound is at least the first of these times what it needed in the step before, and
/// falls from step to step by the second at most.
constexpr double travel_factor = 2.0;
constexpr double kept_travel = 0.7;

double max_length(const std::vector<Vector3d>& vectors) {
  double square = 0.0;
  for (const Vector3d& vector : vectors) {
    square = std::max(square, vector.squaredNorm());
  }
  return std::sqrt(square);
}

}  // namespace

/// Without forces, nodes would go where inertia leads.
void StageSolver::predict_motion(const RodState& reference, double step) {
  travel_bound_.start = start_.positions;
  travel_bound_.expected.resize(travel_bound_.start.size());
  for (std::size_t i = 0; i < travel_bound_.start.size(); ++i) {
    travel_bound_.expected[i] =
        reference.positions[i] + step * reference.velocities[i] - travel_bound_.start[i];
  }
}

/// Widens the travel bounds of rods that need it, up to a length beyond which no step goes. Then no
/// displacements are expected any more: bounds hold for whatever the rods do.
void StageSolver::widen_travel_bound(const Rods& rods) {
  constexpr double edges = 8.0;
  constexpr double displacements = 4.0;
  const double widest =
      edges * *std::max_element(rods.rest_lengths.begin(), rods.rest_lengths.end()) +
      displacements * max_length(travel_bound_.expected);
  for (Group& group : groups_) {
    for (const auto& [rod, needed] : group.needed_travel) {
      travel_bound_.by_rod[rod] = std::max(travel_bound_.by_rod[rod], needed);
      travel_bound_.is_final |= needed > widest;
    }
    group.needed_travel.clear();
  }
  if (travel_bound_.is_final) {
    std::fill(travel_bound_.by_rod.begin(), travel_bound_.by_rod.end(), widest);
    std::fill(travel_bound_.expected.begin(), travel_bound_.expected.end(), Vector3d::Zero());
    for (Group& group : groups_) {
      group.is_solved = false;
    }
  }
}

void StageSolver::adapt_travel_bound(const Rods& rods) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    double square = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      const Vector3d off = rods.positions[i] - travel_bound_.start[i] - travel_bound_.expected[i];
      square = std::max(square, off.squaredNorm());
    }
    travel_bound_.by_rod[rod] =
        std::max({StepBound::min_travel * rods.radii[rod], travel_factor * std::sqrt(square),
                  travel_bound_.is_final ? 0.0 : kept_travel * travel_bound_.by_rod[rod]});
  }
}

}  // namespace fiber
