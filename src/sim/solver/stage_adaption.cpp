// What a solve learns for the next one: how much room rods need, and how stiff contacts are to be.

#include <algorithm>
#include <cmath>

#include "src/sim/solver/stage_solver.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Room that a rod has at the least, in parts of what it has needed in the step before. What is not
/// needed any more is given up little by little.
constexpr double spare_room = 2.0;
constexpr double kept_room = 0.7;

double longest_of(const std::vector<Vector3d>& vectors) {
  double square = 0.0;
  for (const Vector3d& vector : vectors) {
    square = std::max(square, vector.squaredNorm());
  }
  return std::sqrt(square);
}

}  // namespace

/// Where nodes are expected to go.
void StageSolver::expect(const RodState& reference, double step) {
  room_.start = start_.positions;
  room_.expected.resize(room_.start.size());
  for (std::size_t i = 0; i < room_.start.size(); ++i) {
    room_.expected[i] = reference.positions[i] + step * reference.velocities[i] - room_.start[i];
  }
}

/// Rods that went too far get more room, up to a length beyond which no step goes. Then no ways are
/// expected: rooms hold whatever parts of these rods go.
void StageSolver::widen_room(const Rods& rods) {
  constexpr double edges = 8.0;
  constexpr double ways = 4.0;
  const double most =
      edges * *std::max_element(rods.rest_lengths.begin(), rods.rest_lengths.end()) +
      ways * longest_of(room_.expected);
  for (Group& group : groups_) {
    for (const auto& [rod, needed] : group.needed_room) {
      room_.by_rod[rod] = std::max(room_.by_rod[rod], needed);
      room_.is_last |= needed > most;
    }
    group.needed_room.clear();
  }
  if (room_.is_last) {
    std::fill(room_.by_rod.begin(), room_.by_rod.end(), most);
    std::fill(room_.expected.begin(), room_.expected.end(), Vector3d::Zero());
    for (Group& group : groups_) {
      group.is_solved = false;
    }
  }
}

void StageSolver::adapt_room(const Rods& rods) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    double square = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      const Vector3d off = rods.positions[i] - room_.start[i] - room_.expected[i];
      square = std::max(square, off.squaredNorm());
    }
    room_.by_rod[rod] =
        std::max({StepBound::least_room * rods.radii[rod], spare_room * std::sqrt(square),
                  room_.is_last ? 0.0 : kept_room * room_.by_rod[rod]});
  }
}

/// Barriers are as stiff as the material makes natural; where holds pull far harder, they would
/// hold only right at their inner distance, where equations are hard to solve.
void StageSolver::stiffen_contacts() {
  for (ContactSet& found : found_by_) {
    for (EdgePair& pair : found.pairs) {
      pair.barrier.scale *= std::max(stiffening_[pair.rod_a], stiffening_[pair.rod_b]);
    }
    for (ObstacleContact& contact : found.obstacle_contacts) {
      contact.barrier.scale *= stiffening_[contact.rod];
    }
  }
}

/// To what the largest contact force of a rod was in this step; back to the material's little by
/// little.
void StageSolver::adapt_stiffening(const Rods& rods) {
  constexpr double kept = 0.95;
  constexpr double most_growth = 4.0;
  loads_.assign(rods.count(), 0.0);
  for (const Group& group : groups_) {
    // Forces that do not balance tell nothing of what contacts have to hold.
    const bool is_balanced = std::all_of(
        group.reports.begin(), group.reports.end(),
        [this](const IslandReport& report) { return report.residual <= options_.residual; });
    if (is_balanced) {
      add_loads(group.contacts.terms(), loads_);
    }
  }
  const std::vector<double> before = stiffening_;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    stiffening_[rod] = std::max(1.0, stiffening_[rod] * std::clamp(loads_[rod], kept, most_growth));
  }
  for (Group& group : groups_) {
    group.stiffening_energy = group.contacts.stiffening_energy(before, stiffening_);
  }
}

}  // namespace fiber
