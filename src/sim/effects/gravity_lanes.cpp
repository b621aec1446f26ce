// Compiled once per instruction set; Highway chooses among them at run time.
#include "fiber_proximity/sim/effects/gravity.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/effects/gravity_lanes.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

Vector vector(const Eigen::Vector3d& v) { return {{real(v.x()), real(v.y()), real(v.z())}}; }

void energy(const RodLanes& rods, const Eigen::Vector3d& acceleration, Lanes& energy) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    const Vector a = vector(acceleration);
    Real sum = real(0.0);
    for (std::size_t i = 0; i < rods.node_count; ++i) {
      sum = sum - load(rods.masses[i], lane) * dot(a, position_at(rods, i, lane));
    }
    store(sum, energy, lane);
  }
}

template <std::size_t U>
void add_derivatives_of(const RodLanes& rods, const Eigen::Vector3d& acceleration,
                        LaneSystem& system) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    const Vector upward = negative(vector(acceleration));
    for (std::size_t i = 0; i < rods.node_count; ++i) {
      add_gradient<U>(load(rods.masses[i], lane) * upward, i, lane, system);
    }
  }
}

void add_derivatives(const RodLanes& rods, const Eigen::Vector3d& acceleration,
                     LaneSystem& system) {
  system.unknowns == 3 ? add_derivatives_of<3>(rods, acceleration, system)
                       : add_derivatives_of<4>(rods, acceleration, system);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(energy);
HWY_EXPORT(add_derivatives);

void Gravity::energy_in_lanes(const RodLanes& rods, const std::vector<Lanes>& /*values*/,
                              Lanes& energy) const {
  HWY_DYNAMIC_DISPATCH(energy)(rods, acceleration_, energy);
}

void Gravity::add_derivatives_in_lanes(const RodLanes& rods, const std::vector<Lanes>& /*values*/,
                                       LaneSystem& system) const {
  HWY_DYNAMIC_DISPATCH(add_derivatives)(rods, acceleration_, system);
}

}  // namespace fiber
#endif
