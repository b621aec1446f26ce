#include "src/cuda/device_fibers.hpp"

#include <stdexcept>
#include <string>

#include "src/bounds/bounding_volume.hpp"

namespace fiber {

HostTopology topology_of(const std::vector<std::uint32_t>& offsets) {
  HostTopology topology;
  topology.first_points.reserve(offsets.back());
  topology.fibers.reserve(offsets.back());
  for (std::uint32_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    for (std::uint32_t point = offsets[fiber]; point < offsets[fiber + 1]; ++point) {
      topology.fibers.push_back(fiber);
      if (point + 1 < offsets[fiber + 1]) {
        topology.first_points.push_back(point);
      }
    }
  }
  return topology;
}

void require_tree_size(std::size_t segment_count) {
  if (segment_count > SegmentTreeView::max_segments) {
    throw std::invalid_argument("cuda_tree takes at most " +
                                std::to_string(SegmentTreeView::max_segments) +
                                " segments, there are " + std::to_string(segment_count));
  }
}

HostFibers host_fibers(const FiberAssembly& fibers, std::vector<double>& radii) {
  HostFibers host;
  host.point_count = fibers.point_count();
  host.radius = fibers.radii().front();
  if (fibers.radius_per() != RadiusPer::ASSEMBLY) {
    radii.resize(fibers.point_count());
    for (std::uint32_t point = 0; point < fibers.point_count(); ++point) {
      radii[point] = fibers.segment_radius(point);
    }
    host.radii = radii.data();
  }
  return host;
}

void refuse_points(const HostFibers& fibers) {
  for (std::size_t point = 0; point < fibers.point_count; ++point) {
    const double* const from = fibers.coordinates + 3 * point;
    require_coordinates(("point " + std::to_string(point)).c_str(), {from[0], from[1], from[2]});
  }
  throw std::invalid_argument("points have changed while they were read");
}

PairRule pair_rule(double bound, std::uint32_t neighbour_skip, Pairing pairing) {
  PairRule rule;
  rule.bound = round_up(bound);
  rule.neighbour_skip = neighbour_skip;
  rule.same_fiber = pairing != Pairing::DIFFERENT_FIBERS;
  rule.different_fibers = pairing != Pairing::SAME_FIBER;
  return rule;
}

}  // namespace fiber
