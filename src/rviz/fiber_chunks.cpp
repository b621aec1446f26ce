#include "src/rviz/fiber_chunks.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <utility>

namespace fiber_proximity_rviz {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;

/// A stretch and what chunks are made by.
struct Part {
  Stretch stretch;
  Vector3d middle;  // [m]
};
using Parts = std::vector<Part>;

Parts cut(const FiberAssembly& fibers) {
  Parts parts;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
    for (std::uint32_t point = fibers.offsets()[fiber]; point < last;) {
      const std::uint32_t end = point + std::min(most_stretch_segments, last - point);
      parts.push_back({{point, end}, fibers.points()[point + (end - point) / 2]});
      point = end;
    }
  }
  return parts;
}

std::size_t segment_count(Parts::const_iterator begin, Parts::const_iterator end) {
  std::size_t count = 0;
  for (auto part = begin; part != end; ++part) {
    count += part->stretch.last - part->stretch.first;
  }
  return count;
}

/// Halves them where they extend farthest until each part is small enough.
void split(Parts::iterator begin, Parts::iterator end,
           std::vector<std::pair<Parts::iterator, Parts::iterator>>& groups) {
  if (end - begin <= 1 || segment_count(begin, end) <= most_chunk_segments) {
    groups.emplace_back(begin, end);
    return;
  }
  Eigen::AlignedBox3d box;
  for (auto part = begin; part != end; ++part) {
    box.extend(part->middle);
  }
  Eigen::Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const auto half = begin + (end - begin) / 2;
  std::nth_element(begin, half, end, [axis](const Part& a, const Part& b) {
    return a.middle[axis] != b.middle[axis] ? a.middle[axis] < b.middle[axis]
                                            : a.stretch.first < b.stretch.first;
  });
  split(begin, half, groups);
  split(half, end, groups);
}

FiberChunk make_chunk(const FiberAssembly& fibers, const Vector3d& origin,
                      Parts::const_iterator begin, Parts::const_iterator end) {
  FiberChunk chunk;
  chunk.segment_count = segment_count(begin, end);
  for (auto part = begin; part != end; ++part) {
    const Stretch& stretch = part->stretch;
    chunk.stretches.push_back(stretch);
    for (std::uint32_t point = stretch.first; point <= stretch.last; ++point) {
      chunk.box.extend((fibers.points()[point] - origin).cast<float>());
      if (point < stretch.last) {
        chunk.largest_radius = std::max(chunk.largest_radius, fibers.segment_radius(point));
      }
    }
  }
  const auto radius = static_cast<float>(chunk.largest_radius);
  chunk.box.min().array() -= radius;
  chunk.box.max().array() += radius;
  return chunk;
}

}  // namespace

std::vector<FiberChunk> make_chunks(const FiberAssembly& fibers, const Vector3d& origin) {
  Parts parts = cut(fibers);
  if (parts.empty()) {
    return {};
  }
  std::vector<std::pair<Parts::iterator, Parts::iterator>> groups;
  split(parts.begin(), parts.end(), groups);
  std::vector<FiberChunk> chunks(groups.size());
  tbb::parallel_for(std::size_t{0}, groups.size(), [&](std::size_t i) {
    chunks[i] = make_chunk(fibers, origin, groups[i].first, groups[i].second);
  });
  return chunks;
}

}  // namespace fiber_proximity_rviz
