// Compiled once per instruction set; Highway chooses among them at run time.
#include <stdexcept>
#include <utility>

#include "fiber_proximity/sim/effects.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/gravity.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

Vector vector(const double* v) { return {{real(v[0]), real(v[1]), real(v[2])}}; }

void gravity_energy(const RodPack& rods, const NodeValues& /*values*/, const double* acceleration,
                    SimdBatch& energy) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Vector a = vector(acceleration);
    Real sum = real(0.0);
    for (std::size_t i = 0; i < rods.node_count; ++i) {
      sum = sum - load(rods.masses[i], lane) * dot(a, position_at(rods, i, lane));
    }
    store(sum, energy, lane);
  }
}

template <std::size_t U>
void add_gravity_of(const RodPack& rods, const double* acceleration, PackSystem& system) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Vector upward = negative(vector(acceleration));
    for (std::size_t i = 0; i < rods.node_count; ++i) {
      add_gradient<U>(load(rods.masses[i], lane) * upward, i, lane, system);
    }
  }
}

void add_gravity(const RodPack& rods, const NodeValues& /*values*/, const double* acceleration,
                 PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_gravity_of<u>(rods, acceleration, system); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

using Eigen::Vector3d;

HWY_EXPORT(gravity_energy);
HWY_EXPORT(add_gravity);

Gravity::Gravity(const Vector3d& acceleration) : acceleration_(acceleration) {
  if (!acceleration.allFinite()) {
    throw std::invalid_argument("gravity: the acceleration is (" +
                                std::to_string(acceleration.x()) + ", " +
                                std::to_string(acceleration.y()) + ", " +
                                std::to_string(acceleration.z()) + ") m/s^2, it must be finite");
  }
}

GravityInTime::GravityInTime(TimeTable<Vector3d> acceleration)
    : Gravity(acceleration.at(0.0)), table_(std::move(acceleration)) {
  for (const auto& entry : table_.entries()) {
    Gravity{entry.value};  // which refuses what is not finite
  }
}

void GravityInTime::begin_step(Rods& /*rods*/, const TimeStep& step) {
  acceleration_ = table_.at(step.end());
}

LaneEffect::Kernels Gravity::kernels() const {
  return {&HWY_DYNAMIC_DISPATCH(gravity_energy), &HWY_DYNAMIC_DISPATCH(add_gravity),
          acceleration_.data()};
}

}  // namespace fiber
#endif
