#include "fiber_proximity/sim/effects/damping.hpp"

#include <algorithm>

#include "../require.hpp"
#include "fiber_proximity/sim/edge_pair.hpp"
#include "fiber_proximity/sim/effects/twist.hpp"

namespace fiber {

using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

/// Below this length of the sum of two tangents a rod is folded, and has no frame to compare its
/// turns in.
constexpr double folded = 1e-3;

Vector3d middle_of(const EdgePair& pair) { return pair.before().tangent + pair.after().tangent; }

/// What has changed of the turn, apart from rigid rotation.
Vector3d turn_change(const EdgePair& pair, const Vector3d& old_turn, const Vector3d& old_middle) {
  return pair.turn() - transport(old_turn, old_middle, middle_of(pair).normalized());
}

/// Half the gradient of the change's square by the middle, which takes the old turn along: around
/// that the old turn rotates as Twist's directors do around their edges.
Vector3d by_middle(const EdgePair& pair, const Vector3d& change, const Vector3d& old_middle) {
  const Vector3d middle = middle_of(pair);
  const Vector3d axis = middle.normalized();
  const Vector3d binormal = curvature_binormal(old_middle, axis);
  return -0.5 * axis.dot(change.cross(pair.turn())) / std::max(folded, middle.norm()) * binormal;
}

}  // namespace

Damping::Damping(double relaxation_time) : relaxation_time_(relaxation_time) {
  require_not_negative("damping: the relaxation time", relaxation_time, " s");
}

void Damping::begin_step(Rods& rods, const TimeStep& step) {
  share_ = relaxation_time_ / step.length;
  starts_.resize(rods.positions.size());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    EdgeDirection before = edge_direction(rods, rods.first(rod));
    starts_[rods.first(rod)].length = before.length;
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      const EdgePair pair(before, edge_direction(rods, i));
      const EdgeDirection middle = direction_of(middle_of(pair));
      starts_[i].length = pair.after().length;
      starts_[i].turn = pair.turn();
      starts_[i].middle = middle.length > folded ? middle.tangent : Vector3d(Vector3d::Zero());
      before = pair.after();
    }
  }
}

const double* Damping::values_of(std::uint32_t node) const {
  static_assert(sizeof(Start) == 7 * sizeof(double));
  return starts_[node].turn.data();
}

double Damping::energy(const Rods& rods, std::uint32_t rod) const {
  double stretch = 0.0;
  double bend = 0.0;
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
    const double change = edge_direction(rods, i).length - starts_[i].length;
    stretch += change * change / rods.rest_lengths[i];
    if (i > rods.first(rod) && !starts_[i].middle.isZero(0.0)) {
      bend += turn_change(EdgePair(rods, i), starts_[i].turn, starts_[i].middle).squaredNorm() /
              rods.rest_length_at(i);
    }
  }
  const RodSection& section = rods.sections[rod];
  return 0.5 * share_ * (section.stretching_stiffness * stretch + section.bending_stiffness * bend);
}

void Damping::add_derivatives(const Rods& rods, std::uint32_t rod, RodSystem& system) const {
  const RodSection& section = rods.sections[rod];
  const std::uint32_t first = rods.first(rod);
  for (std::uint32_t i = first; i + 1 < rods.end(rod); ++i) {
    const std::uint32_t node = i - first;
    const EdgeDirection edge = edge_direction(rods, i);
    const double stretching = share_ * section.stretching_stiffness / rods.rest_lengths[i];
    const Vector3d force = stretching * (edge.length - starts_[i].length) * edge.tangent;
    const Matrix3d block = stretching * edge.tangent * edge.tangent.transpose();
    system.add_edge(node, force, block);
    if (node > 0 && !starts_[i].middle.isZero(0.0)) {
      const EdgePair pair(rods, i);
      const double bending = share_ * section.bending_stiffness / rods.rest_length_at(i);
      const Vector3d change = turn_change(pair, starts_[i].turn, starts_[i].middle);
      pair.add_derivatives(node, bending * change, bending, 0.0, Vector3d::Zero(), system);
      const Vector3d gradient = bending * by_middle(pair, change, starts_[i].middle);
      pair.add_gradient(node, gradient, gradient, system);
    }
  }
}

}  // namespace fiber
