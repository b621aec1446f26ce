#include "src/geometry/select_fibers.hpp"

#include <cassert>
#include <utility>

namespace fiber {

FiberAssembly select_fibers(const FiberAssembly& fibers,
                            const std::vector<std::uint32_t>& selection) {
  const std::vector<double>& all_radii = fibers.radii();
  const bool radius_shared = all_radii.size() == 1;
  const bool radius_per_fiber = !radius_shared && all_radii.size() == fibers.fiber_count();
  std::vector<std::uint32_t> offsets{0};
  offsets.reserve(selection.size() + 1);
  for (const std::uint32_t fiber : selection) {
    assert(fiber < fibers.fiber_count());
    offsets.push_back(offsets.back() + fibers.offsets()[fiber + 1] - fibers.offsets()[fiber]);
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(offsets.back());
  std::vector<double> radii;
  for (const std::uint32_t fiber : selection) {
    const std::uint32_t begin = fibers.offsets()[fiber];
    const std::uint32_t end = fibers.offsets()[fiber + 1];
    points.insert(points.end(), fibers.points().begin() + begin, fibers.points().begin() + end);
    if (radius_per_fiber) {
      radii.push_back(all_radii[fiber]);
    } else if (!radius_shared) {
      radii.insert(radii.end(), all_radii.begin() + begin, all_radii.begin() + end);
    }
  }
  if (radii.empty()) {
    radii.push_back(all_radii.front());
  }
  return {std::move(points), std::move(offsets), std::move(radii)};
}

}  // namespace fiber
