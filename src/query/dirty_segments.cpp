#include "src/query/dirty_segments.hpp"

namespace fiber {

void DirtySegments::clear() {
  for (const std::uint32_t point : first_points_) {
    is_outdated_[point] = 0;
  }
  first_points_.clear();
}

void DirtySegments::add(const FiberAssembly& fibers, std::uint32_t fiber) {
  is_outdated_.resize(fibers.point_count());
  for (std::uint32_t point = fibers.offsets()[fiber]; point + 1 < fibers.offsets()[fiber + 1];
       ++point) {
    if (is_outdated_[point] == 0) {
      is_outdated_[point] = 1;
      first_points_.push_back(point);
    }
  }
}

void DirtySegments::fit(const FiberAssembly& fibers, const Eigen::Vector3d& origin) {
  tree_.build(fibers, first_points_, origin);
}

std::size_t DirtySegments::memory_bytes() const {
  return first_points_.capacity() * sizeof(std::uint32_t) + is_outdated_.capacity() +
         tree_.memory_bytes();
}

}  // namespace fiber
