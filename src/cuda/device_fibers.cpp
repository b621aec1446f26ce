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

void add_candidates(const std::vector<std::uint32_t>& offsets,
                    const std::vector<std::uint32_t>& candidates, HostTopology& topology) {
  const auto fiber_count = static_cast<std::uint32_t>(offsets.size()) - 1;
  const auto count = static_cast<std::uint32_t>(candidates.size()) - 1;
  topology.candidates_of_fibers.assign(fiber_count, count);
  std::uint32_t segments = 0;
  std::uint32_t fiber = 0;
  for (std::uint32_t candidate = 0; candidate <= count; ++candidate) {
    topology.candidate_points.push_back(offsets[fiber]);
    topology.candidate_segments.push_back(segments);
    const std::uint32_t end = candidate < count ? candidates[candidate + 1] : fiber;
    for (; fiber < end; ++fiber) {
      topology.candidates_of_fibers[fiber] = candidate;
      const std::uint32_t points = offsets[fiber + 1] - offsets[fiber];
      segments += points == 0 ? 0 : points - 1;
    }
  }
}

void require_candidates(const std::vector<std::uint32_t>& candidates, std::size_t fiber_count) {
  const auto refuse = [&](std::size_t index) {
    throw std::invalid_argument(
        "candidates[" + std::to_string(index) + "] is " + std::to_string(candidates[index]) +
        ", they must begin with 0, not decrease, and be at most the number of fibres, " +
        std::to_string(fiber_count));
  };
  if (candidates.empty()) {
    throw std::invalid_argument(
        "candidates has no values, it needs at least 1: where what stands still begins");
  }
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const bool is_allowed = i == 0 ? candidates[i] == 0 : candidates[i] >= candidates[i - 1];
    if (!is_allowed || candidates[i] > fiber_count) {
      refuse(i);
    }
  }
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

PairRule pair_rule(double bound, std::uint32_t neighbour_skip, Pairing pairing) {
  PairRule rule;
  rule.bound = round_up(bound);
  rule.neighbour_skip = neighbour_skip;
  rule.same_fiber = pairing != Pairing::DIFFERENT_FIBERS;
  rule.different_fibers = pairing != Pairing::SAME_FIBER;
  return rule;
}

}  // namespace fiber
