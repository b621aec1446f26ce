// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/gravity.hpp"

#include <stdexcept>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/gravity.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

Vector vector(const Eigen::Vector3d& v) { return {{real(v.x()), real(v.y()), real(v.z())}}; }

void energy(const RodPack& rods, const Eigen::Vector3d& acceleration, SimdBatch& energy) {
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
void add_derivatives_of(const RodPack& rods, const Eigen::Vector3d& acceleration,
                        PackSystem& system) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    const Vector upward = negative(vector(acceleration));
    for (std::size_t i = 0; i < rods.node_count; ++i) {
      add_gradient<U>(load(rods.masses[i], lane) * upward, i, lane, system);
    }
  }
}

void add_derivatives(const RodPack& rods, const Eigen::Vector3d& acceleration, PackSystem& system) {
  with_unknowns(system, [&](auto u) { add_derivatives_of<u>(rods, acceleration, system); });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

Gravity::Gravity(const Eigen::Vector3d& acceleration) : acceleration_(acceleration) {
  if (!acceleration.allFinite()) {
    throw std::invalid_argument("gravity: the acceleration must be finite");
  }
}

void Gravity::energy(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                     SimdBatch& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, acceleration_, energy);
}

void Gravity::add_derivatives(const RodPack& rods, const std::vector<SimdBatch>& /*values*/,
                              PackSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, acceleration_, system);
}

}  // namespace fiber
#endif
