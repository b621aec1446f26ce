#include "src/mpi/ordered_pairs.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "src/bounds/bounding_volume.hpp"
#include "src/hierarchy/run_tree.hpp"

namespace fiber {
namespace {

// One in nine of the pairs that are offered is another rank's.
constexpr std::size_t ordered_parts = 8;

/// Points at which segments start, in the order of their names, as points are.
std::vector<std::uint32_t> starts_of_segments(const FiberAssembly& fibers) {
  std::vector<std::uint32_t> starts;
  starts.reserve(fibers.segment_count());
  const std::vector<std::uint32_t>& offsets = fibers.offsets();
  for (std::size_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    for (std::uint32_t point = offsets[fiber]; point + 1 < offsets[fiber + 1]; ++point) {
      starts.push_back(point);
    }
  }
  return starts;
}

GlobalSegment name_at(const LocalFibers& fibers, std::uint32_t point) {
  const SegmentId id = fibers.fibers().segment_id(point);
  return fibers.global_id(id.fiber, id.segment);
}

}  // namespace

void offer_ordered_pairs(const LocalFibers& halo, const LocalFibers& own, PairSink& sink,
                         const std::function<bool()>& is_over, QueryCounts& counts) {
  const std::vector<std::uint32_t> own_starts = starts_of_segments(own.fibers());
  const std::vector<std::uint32_t> halo_starts = starts_of_segments(halo.fibers());
  const Eigen::Vector3d origin = hierarchy_origin(own.fibers());
  // Parts of own segments that follow each other by name, and those of the halo from each on.
  std::array<RunTree, ordered_parts> trees;
  std::array<std::size_t, ordered_parts + 1> cuts{};
  cuts[ordered_parts] = halo_starts.size();
  for (std::size_t part = ordered_parts; part-- > 0;) {
    const std::size_t begin = own_starts.size() * part / ordered_parts;
    const std::size_t end = own_starts.size() * (part + 1) / ordered_parts;
    cuts[part] = cuts[part + 1];
    if (begin < end) {
      const GlobalSegment first = name_at(own, own_starts[begin]);
      const auto cut = std::lower_bound(halo_starts.begin(), halo_starts.end(), first,
                                        [&](std::uint32_t point, const GlobalSegment& name) {
                                          return name_at(halo, point) < name;
                                        });
      cuts[part] = static_cast<std::size_t>(cut - halo_starts.begin());
      trees[part].build({own.fibers(), origin},
                        {own_starts.begin() + static_cast<std::ptrdiff_t>(begin),
                         own_starts.begin() + static_cast<std::ptrdiff_t>(end)});
    }
  }
  for (std::size_t of_halo = 0; of_halo < ordered_parts; ++of_halo) {
    if (cuts[of_halo] == cuts[of_halo + 1]) {
      continue;
    }
    RunTree tree;
    tree.build({halo.fibers(), origin},
               {halo_starts.begin() + static_cast<std::ptrdiff_t>(cuts[of_halo]),
                halo_starts.begin() + static_cast<std::ptrdiff_t>(cuts[of_halo + 1])});
    for (std::size_t part = 0; part <= of_halo; ++part) {
      if (!find_near_segments_until(is_over, tree.view(), 0, tree.view().group_count(),
                                    trees[part].view(), sink, counts.node_tests,
                                    counts.node_overlaps)) {
        return;
      }
    }
  }
}

}  // namespace fiber
