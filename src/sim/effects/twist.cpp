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

#include "src/sim/effects/strains-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

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
      sum = sum + twist * twist * load(rods.inverse_twisting_lengths[i], lane);
    }
    store(real(0.5) * load(rods.twisting_stiffness, lane) * sum, energy, lane);
  }
}

void add_derivatives(const RodPack& rods, const NodeValues& references, const double* /*constants*/,
                     PackSystem& system) {
  assert(system.unknowns == section_unknowns);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real total = load(rods.twisting_stiffness, lane);
    for (std::size_t i = 1; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_twisting_lengths[i], lane);
      const Real moment = stiffness * twist_at(rods, references, i, lane);
      add_square(twist_derivative(rods, i, lane), moment, stiffness, i, lane, system);
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
      forces.twisting_moments[index] += rod.twisting_stiffness(edge) / length * twist;
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
