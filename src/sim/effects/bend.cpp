#include "fiber_proximity/sim/effects/bend.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/edge_pair.hpp"
#include "natural_bend.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// |k| of the natural curvature: that of an arc over the length that belongs to the node.
double natural_turn(const Rods& rods, std::uint32_t node) {
  if (rods.natural_curvatures.empty()) {
    return 0.0;
  }
  const double angle = rods.natural_curvatures[node] * rods.rest_length_at(node);
  return 2.0 * std::sin(0.5 * std::min(angle, M_PI));
}

/// A straight rod that wants to be curved may turn to any side: to the same one at all its nodes.
Vector3d direction_of_turn(const EdgePair& pair) {
  const double turn = pair.turn().norm();
  return turn > 0.0 ? Vector3d(pair.turn() / turn) : pair.before().tangent.unitOrthogonal();
}

}  // namespace

void Bend::begin_step(Rods& rods, const TimeStep& /*step*/) {
  natural_turns_.resize(rods.natural_curvatures.size());
  for (std::uint32_t rod = 0; rod < rods.count() && !natural_turns_.empty(); ++rod) {
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      natural_turns_[i] = natural_turn(rods, i);
    }
  }
}

double Bend::energy(const Rods& rods, std::uint32_t rod) const {
  double energy = 0.0;
  if (!rods.natural_curvature_vectors.empty()) {
    for (std::uint32_t node = 1; node + 1 < rods.node_count(rod); ++node) {
      energy += NaturalBend::at_node(rods, rod, node).energy();
    }
    return energy;
  }
  for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
    const double excess = EdgePair(rods, i).turn().norm() - natural_turn(rods, i);
    energy += excess * excess / rods.rest_length_at(i);
  }
  return 0.5 * rods.sections[rod].bending_stiffness * energy;
}

void Bend::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  if (!rods.natural_curvature_vectors.empty()) {
    for (std::uint32_t node = 1; node + 1 < rods.node_count(rod); ++node) {
      NaturalBend::at_node(rods, rod, node).add_derivatives(system);
    }
    return;
  }
  const std::uint32_t first = rods.first(rod);
  for (std::uint32_t i = first + 1; i + 1 < rods.end(rod); ++i) {
    const EdgePair pair(rods, i);
    const double stiffness = rods.sections[rod].bending_stiffness / rods.rest_length_at(i);
    const double turn = pair.turn().norm();
    const double natural = natural_turn(rods, i);
    const double excess = turn - natural;
    const Vector3d direction = direction_of_turn(pair);
    // A rod that is straighter than it wants to be gives way sideways: as in Stretch.
    const double sideways = natural == 0.0 ? 1.0 : std::max(0.0, excess) / std::max(turn, natural);
    pair.add_derivatives(i - first, stiffness * excess * direction, stiffness * sideways,
                         stiffness * (1.0 - sideways), direction, system);
  }
}

}  // namespace fiber
