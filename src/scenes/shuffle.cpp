#include "fiber_proximity/scenes/shuffle.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

#include "fiber_proximity/scenes/random.hpp"

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

FiberAssembly reordered(const FiberAssembly& fibers, const std::vector<std::uint32_t>& order) {
  assert(order.size() == fibers.fiber_count());
  const bool radius_per_fiber = fibers.radii().size() == fibers.fiber_count();
  const bool radius_per_point = !radius_per_fiber && fibers.radii().size() > 1;
  std::vector<Eigen::Vector3d> points;
  points.reserve(fibers.point_count());
  std::vector<std::uint32_t> offsets{0};
  offsets.reserve(order.size() + 1);
  std::vector<double> radii;
  for (const std::uint32_t fiber : order) {
    const std::uint32_t begin = fibers.offsets()[fiber];
    const std::uint32_t end = fibers.offsets()[fiber + 1];
    points.insert(points.end(), fibers.points().begin() + begin, fibers.points().begin() + end);
    offsets.push_back(static_cast<std::uint32_t>(points.size()));
    if (radius_per_fiber) {
      radii.push_back(fibers.radii()[fiber]);
    } else if (radius_per_point) {
      radii.insert(radii.end(), fibers.radii().begin() + begin, fibers.radii().begin() + end);
    }
  }
  if (radii.empty()) {
    radii = fibers.radii();
  }
  return {std::move(points), std::move(offsets), std::move(radii)};
}

}  // namespace fiber
