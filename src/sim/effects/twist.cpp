// Compiled once per instruction set; Highway chooses among them at run time.
#include <cassert>
#include <stdexcept>
#include <string>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/edges.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/twist.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t unknowns = 4;

/// @param references what Twist keeps of the nodes
HWY_INLINE Real twist_at(const RodPack& rods, const NodeValues& references, std::size_t node,
                         std::size_t lane) {
  return angle_at(rods, node, lane) - angle_at(rods, node - 1, lane) +
         nearest_turn(load(rods.director_twists[node], lane), load(references[node], lane));
}

void energy(const RodPack& rods, const NodeValues& references, const double* /*constants*/,
            SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real twist = twist_at(rods, references, i, lane);
      sum = sum + twist * twist * load(rods.inverse_node_lengths[i], lane);
    }
    store(real(0.5) * load(rods.twisting_stiffness, lane) * sum, energy, lane);
  }
}

/// The derivative of the twist at a node by all unknowns from the previous node to the next one.
struct TwistDerivative {
  static constexpr std::size_t size = 2 * unknowns + 3;
  Real values[size];
};

HWY_INLINE TwistDerivative derivative_at(const RodPack& rods, std::size_t node, std::size_t lane) {
  const Vector binormal =
      curvature_binormal(tangent_at(rods, node - 1, lane), tangent_at(rods, node, lane));
  const Real half = real(0.5);
  const Vector by_previous = director_turn(rods, node - 1, lane) -
                             half * load(rods.inverse_lengths[node - 1], lane) * binormal;
  const Vector by_next =
      director_turn(rods, node, lane) + half * load(rods.inverse_lengths[node], lane) * binormal;
  TwistDerivative derivative;
  for (std::size_t k = 0; k < 3; ++k) {
    derivative.values[k] = by_previous.xyz[k];
    derivative.values[unknowns + k] = hn::Neg(by_previous.xyz[k] + by_next.xyz[k]);
    derivative.values[2 * unknowns + k] = by_next.xyz[k];
  }
  derivative.values[3] = real(-1.0);
  derivative.values[unknowns + 3] = real(1.0);
  return derivative;
}

void add_derivatives(const RodPack& rods, const NodeValues& references, const double* /*constants*/,
                     PackSystem& system) {
  assert(system.unknowns == unknowns);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real total = load(rods.twisting_stiffness, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_node_lengths[i], lane);
      const Real moment = stiffness * twist_at(rods, references, i, lane);
      const TwistDerivative derivative = derivative_at(rods, i, lane);
      const std::size_t start = unknowns * (i - 1);
      SimdBatch* const gradient = &system.gradient[start];
      SimdBatch* const hessian = &system.hessian[start * column_height<unknowns>];
      for (std::size_t c = 0; c < TwistDerivative::size; ++c) {
        add(moment * derivative.values[c], gradient[c], lane);
        const Real scaled = stiffness * derivative.values[c];
        for (std::size_t r = c; r < TwistDerivative::size; ++r) {
          add(scaled * derivative.values[r], hessian[c * column_height<unknowns> + r - c], lane);
        }
      }
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

using Eigen::Vector3d;

namespace {

void validate(const RodSection& section, std::uint32_t rod) {
  if (!(section.twisting_stiffness > 0.0 && section.inertia_per_length > 0.0)) {
    throw std::invalid_argument("twist: rod " + std::to_string(rod) +
                                " needs a twisting stiffness and an inertia per length above 0");
  }
}

}  // namespace

Twist::Twist(Rods& rods) : reference_twists_(rods.positions.size()) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    validate(rods.sections[rod], rod);
  }
  rods.directors.resize(rods.positions.size(), Vector3d::Zero());
  rods.start_tangents.resize(rods.positions.size(), Vector3d::Zero());
  rods.angles.resize(rods.positions.size(), 0.0);
  rods.spins.resize(rods.positions.size(), 0.0);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const Vector3d tangent = edge_direction(rods, i).tangent;
      rods.directors[i] = i == rods.first(rod) ? tangent.unitOrthogonal()
                                               : transport(rods.directors[i - 1],
                                                           rods.start_tangents[i - 1], tangent);
      rods.start_tangents[i] = tangent;
    }
  }
}

LaneEffect::Kernels Twist::kernels() const {
  return {&HWY_DYNAMIC_DISPATCH(energy), &HWY_DYNAMIC_DISPATCH(add_derivatives)};
}

void Twist::add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const {
  for_each_edge(rods, [&](const PackLane& rod, std::uint32_t edge, std::uint32_t index) {
    if (edge > 0) {
      const double directors = rods.director_twists[edge][rod.lane()];
      const double twist =
          rod.angle(edge) - rod.angle(edge - 1) + nearest_turn(directors, values[edge][rod.lane()]);
      const double length = 0.5 * (rod.rest_length(edge - 1) + rod.rest_length(edge));
      forces.twisting_moments[index] += rod.twisting_stiffness() / length * twist;
    }
  });
}

void Twist::end_step(Rods& rods, const TimeStep& /*step*/) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const Vector3d tangent = edge_direction(rods, i).tangent;
      const Vector3d director = transport(rods.directors[i], rods.start_tangents[i], tangent);
      // Rounding errors of many steps would let it lean and grow.
      rods.directors[i] = (director - tangent * tangent.dot(director)).normalized();
      if (tangent.squaredNorm() > 0.0) {
        rods.start_tangents[i] = tangent;
      }
      if (i > rods.first(rod)) {
        const Vector3d carried =
            transport(rods.directors[i - 1], rods.start_tangents[i - 1], tangent);
        reference_twists_[i] =
            nearest_turn(signed_angle(carried, rods.directors[i], tangent), reference_twists_[i]);
      }
    }
  }
}

}  // namespace fiber
#endif
