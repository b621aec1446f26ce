#include "src/accuracy/resampling.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "src/geometry/fiber_graph.hpp"

namespace fiber {
namespace {

/// [m²] from the segment p–q.
double squared_distance(const Eigen::Vector3d& point, const Eigen::Vector3d& p,
                        const Eigen::Vector3d& q) {
  const Eigen::Vector3d along = q - p;
  const double length = along.squaredNorm();
  const double s = length > 0.0 ? std::clamp((point - p).dot(along) / length, 0.0, 1.0) : 0.0;
  return (point - p - s * along).squaredNorm();
}

/// The point between two others that is farthest from their chord in any state.
std::pair<std::uint32_t, double> farthest(const std::vector<const FiberAssembly*>& states,
                                          std::uint32_t first, std::uint32_t last) {
  std::pair<std::uint32_t, double> found{first, 0.0};
  for (const FiberAssembly* state : states) {
    const std::vector<Eigen::Vector3d>& points = state->points();
    for (std::uint32_t i = first + 1; i < last; ++i) {
      const double squared = squared_distance(points[i], points[first], points[last]);
      if (squared > found.second) {
        found = {i, squared};
      }
    }
  }
  return found;
}

/// Points that stay whatever the error: ends of fibres and points of joints, and of a closed fibre
/// two more, so that it keeps three.
std::vector<std::uint32_t> points_to_keep(const FiberAssembly& fibers, std::size_t fiber) {
  const std::uint32_t first = fibers.offsets()[fiber];
  const std::uint32_t last = fibers.offsets()[fiber + 1] - 1;
  std::vector<std::uint32_t> kept{first, last};
  if (fibers.is_closed(fiber)) {
    kept.push_back(first + (last - first) / 3);
    kept.push_back(first + 2 * (last - first) / 3);
  }
  if (fibers.graph() != nullptr) {
    for (std::uint32_t i = fibers.graph()->next_from(first);
         i != FiberGraph::none && fibers.graph()->joint_points()[i].point <= last;
         i = fibers.graph()->has_next(i) ? i + 1 : FiberGraph::none) {
      kept.push_back(fibers.graph()->joint_points()[i].point);
    }
  }
  std::sort(kept.begin(), kept.end());
  kept.erase(std::unique(kept.begin(), kept.end()), kept.end());
  return kept;
}

}  // namespace

std::vector<std::uint32_t> enough_points(const std::vector<const FiberAssembly*>& states,
                                         double error) {
  const std::vector<std::uint32_t>& offsets = states.front()->offsets();
  std::vector<char> stays(states.front()->point_count(), 0);
  std::vector<std::pair<std::uint32_t, std::uint32_t>> chords;
  for (std::size_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    const std::vector<std::uint32_t> kept = points_to_keep(*states.front(), fiber);
    for (std::size_t i = 1; i < kept.size(); ++i) {
      chords.emplace_back(kept[i - 1], kept[i]);
    }
  }
  while (!chords.empty()) {
    const auto [first, last] = chords.back();
    chords.pop_back();
    stays[first] = stays[last] = 1;
    const auto [middle, squared] = farthest(states, first, last);
    if (squared > error * error) {
      chords.emplace_back(first, middle);
      chords.emplace_back(middle, last);
    }
  }
  std::vector<std::uint32_t> points;
  for (std::uint32_t i = 0; i < stays.size(); ++i) {
    if (stays[i] != 0) {
      points.push_back(i);
    }
  }
  return points;
}

FiberAssembly select_points(const FiberAssembly& fibers, const std::vector<std::uint32_t>& points) {
  std::vector<Eigen::Vector3d> selected;
  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii;
  const FiberTopology all = fibers.topology();
  FiberTopology topology;
  std::size_t next = 0;  // of the points
  topology.closed = all.closed;
  topology.joint_tolerance = std::numeric_limits<double>::infinity();
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t begin = fibers.offsets()[fiber];
    const std::uint32_t end = fibers.offsets()[fiber + 1];
    for (; next < points.size() && points[next] < end; ++next) {
      const std::size_t i = next;
      if (fibers.is_closed(fiber) && points[i] == end - 1) {
        continue;  // the first one again
      }
      if (!all.joints.empty()) {
        topology.joints.push_back(all.joints[fibers.given_offsets()[fiber] + (points[i] - begin)]);
      }
      selected.push_back(fibers.points()[points[i]]);
      const std::uint32_t before = points[i] == begin ? begin : points[i - 1];
      const std::uint32_t after = points[i] == end - 1 ? end - 1 : points[i + 1];
      double radius = 0.0;
      for (std::uint32_t point = before; point <= after; ++point) {
        radius = std::max(radius, fibers.radius_at(fiber, point));
      }
      radii.push_back(radius);
    }
    offsets.push_back(static_cast<std::uint32_t>(selected.size()));
  }
  return {std::move(selected), std::move(offsets),
          fibers.radius_per() == RadiusPer::ASSEMBLY ? fibers.radii() : std::move(radii), topology};
}

}  // namespace fiber
