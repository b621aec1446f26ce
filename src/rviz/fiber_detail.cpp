#include "src/rviz/fiber_detail.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "src/geometry/chain_runs.hpp"

namespace fiber_proximity_rviz {
namespace {

using Eigen::Vector3d;

/// What bounds the search for a run.
constexpr std::uint32_t most_run_segments = 64;

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

void keep_points(const std::vector<Vector3d>& points, const std::vector<MeshVertex>& vertices,
                 const Stretch& stretch, double tolerance, std::vector<std::uint32_t>& kept) {
  assert(vertices.size() == edges_of_ribbon * points.size());
  std::uint32_t point = stretch.first;
  while (point < stretch.last) {
    kept.push_back(point);
    std::uint32_t run = 1;
    if (tolerance > 0.0) {
      const std::uint32_t most = std::min(most_run_segments, stretch.last - point);
      run = fiber::long_run(count_alike(vertices, point, most), [&](std::uint32_t count) {
        return std::isfinite(fiber::deviation_of_points(points, point, point + count, tolerance));
      });
    }
    point += run;
  }
  kept.push_back(stretch.last);
}

std::vector<std::uint32_t> make_indices(const std::vector<Vector3d>& points,
                                        const std::vector<MeshVertex>& vertices,
                                        const FiberChunk& chunk, const Detail& detail) {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> kept;
  for (const Stretch& stretch : chunk.stretches) {
    kept.clear();
    keep_points(points, vertices, stretch, detail.tolerance(), kept);
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
