#include "src/ros/inputs/fiber_speeds.hpp"

#include <algorithm>

namespace fiber_proximity_ros {

void FiberSpeeds::take(const FiberMessage& before, const FiberMessage& newest) {
  const fiber::FiberAssembly& fibers = newest.fibers;
  const std::vector<std::uint32_t>& offsets = fibers.offsets();
  const double seconds = (newest.stamp - before.stamp).toSec();
  if (!(seconds > 0.0) || before.names != newest.names || before.fibers.offsets() != offsets) {
    forget();
    return;
  }
  std::vector<double>& speeds = speeds_ ? *speeds_ : speeds_.emplace();
  speeds.assign(fibers.fiber_count(), 0.0);
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t point = offsets[fiber]; point < offsets[fiber + 1]; ++point) {
      const double moved = (fibers.points()[point] - before.fibers.points()[point]).stableNorm();
      speeds[fiber] = std::max(speeds[fiber], moved / seconds);
    }
  }
}

}  // namespace fiber_proximity_ros
