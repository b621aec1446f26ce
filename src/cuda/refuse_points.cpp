// The library has it, and so does the module of GPUs, which cannot ask the library that loads it.

#include <algorithm>
#include <stdexcept>
#include <string>

#include "src/bounds/bounding_volume.hpp"
#include "src/cuda/host_fibers.hpp"

namespace fiber {
namespace {

/// @param candidates where their points begin, and where those of the last end; none without them
std::string name_of(std::size_t point, const std::vector<std::uint32_t>* candidates) {
  if (candidates == nullptr || point >= candidates->back()) {
    return "point " + std::to_string(point);
  }
  const auto next = std::upper_bound(candidates->begin(), candidates->end(), point);
  return "candidate " + std::to_string(next - candidates->begin() - 1) + ", its point " +
         std::to_string(point - *(next - 1));
}

}  // namespace

void refuse_points(const HostFibers& fibers) {
  for (std::size_t point = 0; point < fibers.point_count; ++point) {
    const double* const from = fibers.coordinates + 3 * point;
    require_coordinates(name_of(point, fibers.candidate_points).c_str(),
                        {from[0], from[1], from[2]});
  }
  throw std::invalid_argument("points have changed while they were read");
}

}  // namespace fiber
