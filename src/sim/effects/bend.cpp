// Compiled once per instruction set; Highway chooses among them at run time.
#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "src/sim/require.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/bend.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/effects/strains-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void energy(const RodPack& rods, const NodeValues& /*values*/, const double* /*constants*/,
            SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real sum = real(0.0);
    Vector before = tangent_at(rods, 0, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Vector after = tangent_at(rods, i, lane);
      const Vector turn = after - before;
      sum = sum + dot(turn, turn) * load(rods.inverse_bending_lengths[i], lane);
      before = after;
    }
    store(real(0.5) * load(rods.bending_stiffness, lane) * sum, energy, lane);
  }
}

template <std::size_t U>
void add_derivatives_of(const RodPack& rods, PackSystem& system) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real total = load(rods.bending_stiffness, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_bending_lengths[i], lane);
      const TwoEdges edges = edges_beside(rods, i, lane);
      const Vector gradient = stiffness * (edges.after - edges.before);
      add_gradient<U>(edges, negative(gradient), gradient, i, lane, system);
      add_hessian<U>(isotropic_blocks(edges, stiffness), i, lane, system);
    }
  }
}

void add_derivatives(const RodPack& rods, const NodeValues& /*values*/, const double* /*constants*/,
                     PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_derivatives_of<u>(rods, system); });
}

void curved_energy(const RodPack& rods, const NodeValues& natural, const double* /*constants*/,
                   SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real excess = sized_turn(edges_beside(rods, i, lane), load(natural[i], lane)).excess;
      sum = sum + excess * excess * load(rods.inverse_bending_lengths[i], lane);
    }
    store(real(0.5) * load(rods.bending_stiffness, lane) * sum, energy, lane);
  }
}

/// The direction of the turn; where there is none, any direction across the rod, found lane by
/// lane.
HWY_INLINE Vector direction_of(const SizedTurn& turn, const Vector& tangent) {
  const Real zero = real(0.0);
  const auto is_bent = hn::Gt(turn.size, zero);
  const Vector along = real(1.0) / turn.size * turn.turn;
  if (hn::AllTrue(LaneTag(), is_bent)) {
    return along;
  }
  SimdBatch across[3];
  store(tangent, across, 0);
  for (std::size_t l = 0; l < lanes_at_once(); ++l) {
    const Eigen::Vector3d lane_across =
        Eigen::Vector3d(across[0][l], across[1][l], across[2][l]).unitOrthogonal();
    for (std::size_t k = 0; k < 3; ++k) {
      across[k][l] = lane_across[static_cast<Eigen::Index>(k)];
    }
  }
  Vector direction;
  for (std::size_t k = 0; k < 3; ++k) {
    direction.xyz[k] = hn::IfThenElse(is_bent, along.xyz[k], load(across[k], 0));
  }
  return direction;
}

template <std::size_t U>
void add_curved_derivatives_of(const RodPack& rods, const NodeValues& natural, PackSystem& system) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real total = load(rods.bending_stiffness, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_bending_lengths[i], lane);
      const TwoEdges edges = edges_beside(rods, i, lane);
      const SizedTurn turn = sized_turn(edges, load(natural[i], lane));
      add_sized_turn<U>(edges, turn, direction_of(turn, edges.before), stiffness, real(0.0), i,
                        lane, system);
    }
  }
}

void add_curved_derivatives(const RodPack& rods, const NodeValues& natural,
                            const double* /*constants*/, PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_curved_derivatives_of<u>(rods, natural, system); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

using Eigen::Vector3d;

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);
HWY_EXPORT(curved_energy);
HWY_EXPORT(add_curved_derivatives);

namespace {

/// k₀ of the natural curvature: that of an arc over the length that belongs to the node.
double natural_turn(const Rods& rods, std::uint32_t node) {
  if (rods.natural_curvatures.empty()) {
    return 0.0;
  }
  const double angle = rods.natural_curvatures[node] * rods.rest_length_at(node);
  return 2.0 * std::sin(0.5 * std::min(angle, M_PI));
}

/// Natural curvature with a direction is rare, so that rods are visited one after the other.
/// @param function takes lane, node and bend
template <class Function>
void for_each_natural_bend(const RodPack& rods, const NodeValues& values,
                           const Function& function) {
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    for (std::uint32_t node = 1; node + 1 < rods.node_count; ++node) {
      const Eigen::Vector2d curvature(values[std::size_t{2} * node][lane],
                                      values[std::size_t{2} * node + 1][lane]);
      function(lane, node, NaturalBend::at_node(PackLane(rods, lane), node, curvature));
    }
  }
}

void natural_energy(const RodPack& rods, const NodeValues& values, const double* /*constants*/,
                    SimdBatch& energy) {
  energy = SimdBatch{};
  for_each_natural_bend(rods, values,
                        [&](std::size_t lane, std::uint32_t /*node*/, const NaturalBend& bend) {
                          energy[lane] += bend.energy();
                        });
}

void add_natural_derivatives(const RodPack& rods, const NodeValues& values,
                             const double* /*constants*/, PackSystem& system) {
  for_each_natural_bend(rods, values,
                        [&](std::size_t lane, std::uint32_t /*node*/, const NaturalBend& bend) {
                          RodSystem rod_system(system, lane);
                          bend.add_derivatives(rod_system);
                        });
}

}  // namespace

void Bend::begin_step(Rods& rods, const TimeStep& /*step*/) {
  natural_curvatures_ = rods.natural_curvature_vectors;
  natural_turns_.resize(natural_curvatures_.empty() ? rods.natural_curvatures.size() : 0);
  for (std::uint32_t rod = 0; rod < rods.count() && !natural_turns_.empty(); ++rod) {
    for (std::uint32_t i = rods.first(rod) + 1; i + 1 < rods.end(rod); ++i) {
      natural_turns_[i] = natural_turn(rods, i);
    }
  }
}

NodeData Bend::per_node_data() const {
  if (!natural_curvatures_.empty()) {
    return {natural_curvatures_.front().data(), 2};
  }
  return {natural_turns_.data(), natural_turns_.empty() ? 0U : 1U};
}

LaneEffect::Kernels Bend::kernels() const {
  if (!natural_curvatures_.empty()) {
    return {&natural_energy, &add_natural_derivatives};
  }
  if (natural_turns_.empty()) {
    return {&HWY_DYNAMIC_DISPATCH(energy), &HWY_DYNAMIC_DISPATCH(add_derivatives)};
  }
  return {&HWY_DYNAMIC_DISPATCH(curved_energy), &HWY_DYNAMIC_DISPATCH(add_curved_derivatives)};
}

void Bend::add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const {
  if (!natural_curvatures_.empty()) {
    for_each_natural_bend(rods, values,
                          [&](std::size_t lane, std::uint32_t node, const NaturalBend& bend) {
                            forces.bending_moments[rods.first_nodes[lane] + node] += bend.moment();
                          });
    return;
  }
  for_each_edge(rods, [&](const PackLane& rod, std::uint32_t edge, std::uint32_t index) {
    if (edge > 0) {
      const Vector3d before = rod.direction(edge - 1).tangent;
      const Vector3d after = rod.direction(edge).tangent;
      const double natural = natural_turns_.empty() ? 0.0 : natural_turns_[index];
      const double turn = (after - before).norm();
      const double length = 0.5 * (rod.rest_length(edge - 1) + rod.rest_length(edge));
      const double share = turn > 0.0 ? 1.0 - natural / turn : 0.0;
      forces.bending_moments[index] +=
          rod.bending_stiffness(edge) / length * share * before.cross(after);
    }
  });
}

Plasticity::Plasticity(Rods& rods, const Options& options) : options_(options) {
  require_positive("plasticity: the yield strain", options.yield_strain);
  require(options.hardening >= 0.0 && options.hardening < 1.0, "plasticity: the hardening",
          options.hardening, "", "at least 0 and less than 1");
  if (!rods.natural_curvature_vectors.empty()) {
    throw std::invalid_argument(
        "plasticity: what stays has no direction, natural curvature must have none, too");
  }
  if (!rods.stiff_sides.empty()) {
    throw std::invalid_argument(
        "plasticity: what stays has no direction, no fibre must be stiffer to one side");
  }
  rods.natural_curvatures.resize(rods.positions.size(), 0.0);
}

void Plasticity::end_step(Rods& rods, const TimeStep& /*step*/) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const auto bend = [&](std::uint32_t node, std::uint32_t edge, std::uint32_t next, double length,
                          double share) {
      const double yield = share * options_.yield_strain / rods.node_radius(rod, node);
      const Vector3d turn = edge_direction(rods, next).tangent - edge_direction(rods, edge).tangent;
      const double half_turn = std::min(1.0, 0.5 * turn.norm());
      const double curvature = 2.0 * std::asin(half_turn) / length;
      const double elastic = curvature - rods.natural_curvatures[node];
      const double excess = std::abs(elastic) - yield;
      if (excess > 0.0) {
        rods.natural_curvatures[node] +=
            std::copysign((1.0 - options_.hardening) * excess, elastic);
      }
    };
    const std::uint32_t first = rods.first(rod);
    const std::uint32_t last = rods.end(rod) - 1;
    for (std::uint32_t i = first + 1; i < last; ++i) {
      bend(i, i - 1, i, rods.rest_length_at(i), rods.bending_share_at(i));
    }
    if (rods.is_closed(rod)) {
      bend(first, last - 1, first, rods.rest_length_at_seam(rod), 1.0);
      rods.natural_curvatures[last] = rods.natural_curvatures[first];
    }
  }
}

}  // namespace fiber
#endif
