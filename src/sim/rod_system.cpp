#include "fiber_proximity/sim/rod_system.hpp"

#include <algorithm>

namespace fiber {

RodSystem::RodSystem(std::uint32_t node_count, std::uint32_t unknowns)
    : unknowns_(unknowns),
      hessian_(std::size_t{node_count} * unknowns,
               unknowns == 3 ? BandMatrix::without_twist : BandMatrix::with_twist),
      gradient_(hessian_.size()),
      entries_(hessian_.data()),
      gradients_(gradient_.data()),
      stride_(1) {
  assert(unknowns == 3 || unknowns == 4);
}

RodSystem::RodSystem(LaneSystem& system, std::size_t lane)
    : unknowns_(3),
      hessian_(0, BandMatrix::without_twist),
      entries_(&system.hessian[0][lane]),
      gradients_(&system.gradient[0][lane]),
      stride_(lane_count) {}

void RodSystem::set_zero() {
  hessian_.set_zero();
  std::fill(gradient_.begin(), gradient_.end(), 0.0);
}

void RodSystem::hold(std::uint32_t node) {
  for (std::size_t i = std::size_t{node} * unknowns_, end = i + 3; i < end; ++i) {
    decouple(i, hessian_.half_bandwidth(), stride_, entries_);
    gradients_[i * stride_] = 0.0;
  }
}

void RodSystem::factorise() {
  // All effects add positive semidefinite blocks, and masses are positive: only rounding errors can
  // make it indefinite, and what it solves for then still lets the energy fall.
  hessian_.factorise();
}

}  // namespace fiber
