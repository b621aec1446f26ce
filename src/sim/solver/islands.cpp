#include "src/sim/solver/islands.hpp"

#include <algorithm>
#include <numeric>

namespace fiber {

void Islands::reset(std::uint32_t rods) {
  parents_.resize(rods);
  std::iota(parents_.begin(), parents_.end(), 0U);
}

void Islands::join(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t root_a = of(a);
  const std::uint32_t root_b = of(b);
  const std::uint32_t root = std::min(root_a, root_b);
  parents_[std::max(root_a, root_b)] = root;
  // Ways to the root stay short.
  parents_[a] = parents_[b] = root;
}

std::uint32_t Islands::of(std::uint32_t rod) const {
  while (parents_[rod] != rod) {
    rod = parents_[rod];
  }
  return rod;
}

}  // namespace fiber
