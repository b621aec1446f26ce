#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "src/environment/eight_boxes.hpp"
#include "src/environment/shape_boxes.hpp"
#include "src/environment/world_shape.hpp"

namespace fiber {

/// Consecutive segments of one fibre, whose boxes are looked up at once: at most eight.
struct SegmentRun {
  std::uint32_t fiber;
  std::uint32_t begin;  // first points of the segments
  std::uint32_t end;
  EightBoxes boxes;     // around the axis of each, wherever it is [m]
  WorldBox box;         // around all of these [m]
  double radius = 0.0;  // the largest [m]
};

/// Calls look(run) for each run of the fibres' segments that begins at one of these points, until
/// the query is done().
/// @tparam Query says how many segments a run has, what box the axis of one is in and how thick it
///               is
template <class Query, class Look>
void for_each_run(const FiberAssembly& fibers, PointRange points, Query& query, const Look& look) {
  constexpr std::uint32_t length = Query::segments_per_run;
  static_assert(length <= EightBoxes::count);
  const std::vector<std::uint32_t>& offsets = fibers.offsets();
  const auto after = std::upper_bound(offsets.begin(), offsets.end(), points.begin);
  for (auto fiber = static_cast<std::uint32_t>(after - offsets.begin()) - 1;
       fiber < fibers.fiber_count() && offsets[fiber] < points.end && !query.done(); ++fiber) {
    const std::uint32_t last = offsets[fiber + 1] - 1;
    const std::uint32_t before = std::max(points.begin, offsets[fiber]) - offsets[fiber];
    for (std::uint32_t first = offsets[fiber] + (before + length - 1) / length * length;
         first < std::min(last, points.end) && !query.done(); first += length) {
      SegmentRun run{fiber, first, std::min(first + length, last), {}, {}};
      for (std::uint32_t point = run.begin; point < run.end; ++point) {
        const WorldBox box = query.box_of(point);
        run.boxes.set(point - run.begin, box);
        run.box.extend(box);
        run.radius = std::max(run.radius, query.radius_of(point));
      }
      look(run);
    }
  }
}

/// All points of the fibres.
inline PointRange all_points(const FiberAssembly& fibers) {
  return {0, static_cast<std::uint32_t>(fibers.point_count())};
}

/// All shapes of some objects, and those of them that are near a box.
struct Environment::BroadPhase {
  explicit BroadPhase(const std::vector<EnvironmentObject>& objects) {
    for (std::uint32_t i = 0; i < objects.size(); ++i) {
      for (std::uint32_t j = 0; j < objects[i].shapes.size(); ++j) {
        shapes.emplace_back(objects[i], i, j);
      }
    }
    boxes.reserve(shapes.size());
    for (const WorldShape& shape : shapes) {
      boxes.add(shape, shape.box);
    }
    boxes.build();
  }

  std::vector<WorldShape> shapes;  // by object, then by their index in it
  ShapeBoxes boxes;
};

}  // namespace fiber
