#include "src/rviz/fiber_detail.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

#include "src/geometry/chain_runs.hpp"

namespace fiber_proximity_rviz {
namespace {

using Eigen::Vector3d;
using fiber::FiberAssembly;

/// A range and what chunks are made by.
struct Part {
  PointRange range;
  Vector3d middle;  // [m]
};
using Parts = std::vector<Part>;

Parts cut(const FiberAssembly& fibers) {
  Parts parts;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
    for (std::uint32_t point = fibers.offsets()[fiber]; point < last;) {
      const std::uint32_t end = point + std::min(max_range_segments, last - point);
      parts.push_back({{point, end}, fibers.points()[point + (end - point) / 2]});
      point = end;
    }
  }
  return parts;
}

std::size_t segment_count(Parts::const_iterator begin, Parts::const_iterator end) {
  std::size_t count = 0;
  for (auto part = begin; part != end; ++part) {
    count += part->range.last - part->range.first;
  }
  return count;
}

/// Halves them where they extend farthest until each part is small enough.
void split(Parts::iterator begin, Parts::iterator end,
           std::vector<std::pair<Parts::iterator, Parts::iterator>>& groups) {
  if (end - begin <= 1 || segment_count(begin, end) <= max_chunk_segments) {
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
                                            : a.range.first < b.range.first;
  });
  split(begin, half, groups);
  split(half, end, groups);
}

FiberChunk make_chunk(const FiberAssembly& fibers, const Vector3d& origin,
                      Parts::const_iterator begin, Parts::const_iterator end) {
  FiberChunk chunk;
  chunk.segment_count = segment_count(begin, end);
  for (auto part = begin; part != end; ++part) {
    const PointRange& range = part->range;
    chunk.ranges.push_back(range);
    for (std::uint32_t point = range.first; point <= range.last; ++point) {
      chunk.box.extend((fibers.points()[point] - origin).cast<float>());
      if (point < range.last) {
        chunk.largest_radius = std::max(chunk.largest_radius, fibers.segment_radius(point));
      }
    }
  }
  const auto radius = static_cast<float>(chunk.largest_radius);
  chunk.box.min().array() -= radius;
  chunk.box.max().array() += radius;
  return chunk;
}

/// Bounds the search for a run.
constexpr std::uint32_t max_run_segments = 64;

bool look_alike(const MeshVertex& a, const MeshVertex& b) {
  return a.color == b.color && a.offset == b.offset;
}

/// How many segments from this point on may be one, for all their points look alike; at least 1.
std::uint32_t count_alike(const std::vector<MeshVertex>& vertices, std::uint32_t begin,
                          std::uint32_t most) {
  std::uint32_t count = 0;
  while (count < most && look_alike(vertices[edges_of_ribbon * (begin + count + 1)],
                                    vertices[edges_of_ribbon * begin])) {
    ++count;
  }
  return std::max(count, 1U);
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

double Detail::tolerance() const { return level == finest ? 0.0 : std::ldexp(1.0, level); }

Detail choose_detail(const FiberChunk& chunk, double pixel, const DetailOptions& options) {
  assert(pixel > 0.0 && options.pixel_error > 0.0F);
  Detail detail;
  if (!options.is_reduced) {
    return detail;
  }
  if (pixel >= 2.0 * chunk.largest_radius) {
    detail.kind = Detail::Kind::lines;
  }
  const double error = std::min(pixel * static_cast<double>(options.pixel_error),
                                std::numeric_limits<double>::max());
  detail.level = std::max(Detail::finest, std::ilogb(error));
  return detail;
}

void simplify(const std::vector<Vector3d>& points, const std::vector<MeshVertex>& vertices,
              const PointRange& range, double tolerance, std::vector<std::uint32_t>& kept) {
  assert(vertices.size() == edges_of_ribbon * points.size());
  std::uint32_t point = range.first;
  while (point < range.last) {
    kept.push_back(point);
    std::uint32_t run = 1;
    if (tolerance > 0.0) {
      const std::uint32_t most = std::min(max_run_segments, range.last - point);
      run = fiber::long_run(count_alike(vertices, point, most), [&](std::uint32_t count) {
        return std::isfinite(fiber::deviation_of_points(points, point, point + count, tolerance));
      });
    }
    point += run;
  }
  kept.push_back(range.last);
}

std::vector<std::uint32_t> make_indices(const std::vector<Vector3d>& points,
                                        const std::vector<MeshVertex>& vertices,
                                        const FiberChunk& chunk, const Detail& detail) {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> kept;
  for (const PointRange& range : chunk.ranges) {
    kept.clear();
    simplify(points, vertices, range, detail.tolerance(), kept);
    for (std::size_t i = 0; i + 1 < kept.size(); ++i) {
      const auto here = static_cast<std::uint32_t>(edges_of_ribbon * kept[i]);
      const auto next = static_cast<std::uint32_t>(edges_of_ribbon * kept[i + 1]);
      if (detail.kind == Detail::Kind::lines) {
        indices.insert(indices.end(), {here, next});
      } else {
        indices.insert(indices.end(), {here, here + 1, next, next, here + 1, next + 1});
      }
    }
  }
  return indices;
}

}  // namespace fiber_proximity_rviz
