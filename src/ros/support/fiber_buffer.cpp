#include "fiber_proximity/ros/fiber_buffer.hpp"

namespace fiber_proximity_ros {

void FiberBuffer::clear() {
  header = std_msgs::Header();
  points.clear();
  offsets.assign(1, 0);
  radii.clear();
  names.clear();
}

void assign(const FiberBuffer& chains, fiber::FiberAssembly& fibers) {
  if (chains.offsets == fibers.offsets() && chains.radii == fibers.radii()) {
    fibers.update_points(chains.points);
  } else {
    fibers = fiber::FiberAssembly(chains.points, chains.offsets, chains.radii);
  }
}

}  // namespace fiber_proximity_ros
