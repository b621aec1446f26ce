// Compiled once per instruction set; Highway chooses among them at run time.
#include <algorithm>
#include <cmath>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/edges.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/stretch.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void stretch_energy(const RodPack& rods, const NodeValues& /*values*/, const double* /*constants*/,
                    SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Real excess = load(rods.lengths[i], lane) - load(rods.rest_lengths[i], lane);
      sum = sum + excess * excess * load(rods.inverse_stretching_lengths[i], lane);
    }
    store(real(0.5) * load(rods.stretching_stiffness, lane) * sum, energy, lane);
  }
}

template <std::size_t U>
void add_stretch_of(const RodPack& rods, PackSystem& system) {
  const Real zero = real(0.0);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Real total = load(rods.stretching_stiffness, lane);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Real stiffness = total * load(rods.inverse_stretching_lengths[i], lane);
      const Real excess = load(rods.lengths[i], lane) - load(rods.rest_lengths[i], lane);
      const Vector tangent = tangent_at(rods, i, lane);
      const Vector force = stiffness * excess * tangent;
      // Under pressure an edge gives way sideways; that part is negative definite and left out.
      const Real sideways = stiffness * hn::Max(zero, excess * load(rods.inverse_lengths[i], lane));
      const Vector along = (stiffness - sideways) * tangent;
      add_edge<U>(force, block_of(sideways, along, tangent), i, lane, system);
    }
  }
}

void add_stretch(const RodPack& rods, const NodeValues& /*values*/, const double* /*constants*/,
                 PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_stretch_of<u>(rods, system); });
}

/// Inextensible::Spring, and the excess of its length.
struct Spring {
  Real tension;
  Real stiffness;
  Real excess;
};

HWY_INLINE Spring spring_at(const RodPack& rods, const NodeValues& values, std::size_t edge,
                            std::size_t lane) {
  return {load(values[2 * edge], lane), load(values[2 * edge + 1], lane),
          load(rods.lengths[edge], lane) - load(rods.rest_lengths[edge], lane)};
}

void spring_energy(const RodPack& rods, const NodeValues& values, const double* /*constants*/,
                   SimdBatch& energy) {
  const Real half = real(0.5);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Real sum = real(0.0);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Spring spring = spring_at(rods, values, i, lane);
      sum = sum + (spring.tension + half * spring.stiffness * spring.excess) * spring.excess;
    }
    store(sum, energy, lane);
  }
}

template <std::size_t U>
void add_springs_of(const RodPack& rods, const NodeValues& values, PackSystem& system) {
  const Real zero = real(0.0);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Spring spring = spring_at(rods, values, i, lane);
      const Vector tangent = tangent_at(rods, i, lane);
      const Real force = spring.tension + spring.stiffness * spring.excess;
      // As in Stretch, the part that is negative definite under pressure is left out.
      const Real sideways = hn::Max(zero, force) * load(rods.inverse_lengths[i], lane);
      const Vector along = (spring.stiffness - sideways) * tangent;
      add_edge<U>(force * tangent, block_of(sideways, along, tangent), i, lane, system);
    }
  }
}

void add_springs(const RodPack& rods, const NodeValues& values, const double* /*constants*/,
                 PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_springs_of<u>(rods, values, system); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(stretch_energy);
HWY_EXPORT(add_stretch);
HWY_EXPORT(spring_energy);
HWY_EXPORT(add_springs);

LaneEffect::Kernels Stretch::kernels() const {
  return {&HWY_DYNAMIC_DISPATCH(stretch_energy), &HWY_DYNAMIC_DISPATCH(add_stretch)};
}

void Stretch::add_forces(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                         RodForces& forces) const {
  for_each_edge(rods, [&](const PackLane& rod, std::uint32_t edge, std::uint32_t index) {
    const double strain = rod.direction(edge).length / rod.rest_length(edge) - 1.0;
    forces.tensions[index] += rod.stretching_stiffness(edge) * strain;
  });
}

Inextensible::Inextensible(const Rods& rods) : springs_(rods.positions.size()) {}

void Inextensible::begin_step(Rods& rods, const TimeStep& step) {
  static_assert(sizeof(Spring) == 2 * sizeof(double), "as per_node_data() has them");
  constexpr double min_ratio = 1e4;
  constexpr double by_edges = 100.0;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const double edges = rods.node_count(rod) - 1;
    const double ratio = std::max(min_ratio, by_edges * edges * edges);
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      springs_[i].stiffness = ratio * rods.masses[i] / (step.length * step.length);
    }
  }
}

double Inextensible::force(const Rods& rods, std::uint32_t edge) const {
  const double excess = edge_direction(rods, edge).length - rods.rest_lengths[edge];
  return springs_[edge].tension + springs_[edge].stiffness * excess;
}

bool Inextensible::update_multipliers(const Rods& rods, std::uint32_t rod) {
  constexpr double allowed_strain = 1e-6;
  bool is_kept = true;
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
    const double force = this->force(rods, i);
    const double excess = (force - springs_[i].tension) / springs_[i].stiffness;
    is_kept &= std::abs(excess) <= allowed_strain * rods.rest_lengths[i];
    springs_[i].tension = force;
  }
  return is_kept;
}

void Inextensible::add_forces(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                              RodForces& forces) const {
  for_each_edge(rods, [&](const PackLane& rod, std::uint32_t edge, std::uint32_t index) {
    const double excess = rod.direction(edge).length - rod.rest_length(edge);
    forces.tensions[index] += springs_[index].tension + springs_[index].stiffness * excess;
  });
}

LaneEffect::Kernels Inextensible::kernels() const {
  return {&HWY_DYNAMIC_DISPATCH(spring_energy), &HWY_DYNAMIC_DISPATCH(add_springs)};
}

}  // namespace fiber
#endif
