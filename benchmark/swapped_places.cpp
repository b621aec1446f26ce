#include "benchmark/swapped_places.hpp"

namespace fiber {

std::vector<Eigen::Vector3d> swapped_places(const FiberAssembly& fibers) {
  std::vector<Eigen::Vector3d> points = fibers.points();
  const std::vector<std::uint32_t>& offsets = fibers.offsets();
  const std::size_t count = fibers.fiber_count();
  for (std::size_t fiber = 0; fiber < count; ++fiber) {
    const Eigen::Vector3d step =
        fibers.points()[offsets[count - 1 - fiber]] - fibers.points()[offsets[fiber]];
    for (std::uint32_t i = offsets[fiber]; i < offsets[fiber + 1]; ++i) {
      points[i] += step;
    }
  }
  return points;
}

}  // namespace fiber
