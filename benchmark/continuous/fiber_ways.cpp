#include "benchmark/continuous/fiber_ways.hpp"

#include "src/scenes/portable_math.hpp"

namespace fiber {

std::vector<Eigen::Vector3d> after_own_ways(const FiberAssembly& before, double way,
                                            std::uint64_t seed) {
  std::vector<Eigen::Vector3d> points = before.points();
  Random random(seed);
  for (std::size_t fiber = 0; fiber < before.fiber_count(); ++fiber) {
    const std::uint32_t first = before.offsets()[fiber];
    const std::uint32_t end = before.offsets()[fiber + 1];
    const Eigen::Vector3d axis = random.direction();
    const Eigen::Vector3d other_axis = perpendicular_unit(random.direction(), axis);
    for (std::uint32_t i = first; i < end; ++i) {
      const double turned = static_cast<double>(i - first) / (end - first);
      points[i] += way * (cosine_of_turns(turned) * axis + sine_of_turns(turned) * other_axis);
    }
  }
  return points;
}

}  // namespace fiber
