#include "src/scenes/shuffle.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "src/scenes/random.hpp"

namespace fiber {

std::vector<std::uint32_t> random_order(std::uint32_t count, std::uint64_t seed) {
  // Apart from the scene's own numbers, which begin with the seed itself.
  Random random(~seed);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  for (std::uint32_t left = count; left > 1; --left) {
    // Rounding may reach the upper limit.
    const auto chosen = static_cast<std::uint32_t>(random.uniform(0.0, left));
    std::swap(order[left - 1], order[std::min(chosen, left - 1)]);
  }
  return order;
}

}  // namespace fiber
