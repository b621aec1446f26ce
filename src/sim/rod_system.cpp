#include "fiber_proximity/sim/rod_system.hpp"

#include <algorithm>

namespace fiber {

void RodSystem::hold(std::uint32_t node) {
  for (std::size_t i = node * unknowns_, end = i + 3; i < end; ++i) {
    decouple(i);
    gradient_[i * lane_count] = 0.0;
  }
}

/// Row and column become those of the identity.
void RodSystem::decouple(std::size_t unknown) {
  for (std::size_t j = 0; j < height_; ++j) {
    hessian_[place_of(unknown + j, unknown)] = j == 0 ? 1.0 : 0.0;
    if (j > 0 && j <= unknown) {
      hessian_[place_of(unknown, unknown - j)] = 0.0;
    }
  }
}

}  // namespace fiber
