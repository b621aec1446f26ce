#pragma once

#include <algorithm>
#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/narrow_phase.hpp"

namespace fiber::test {

/// Bit by bit.
inline bool same(const std::vector<MotionContact>& x, const std::vector<MotionContact>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const MotionContact& a, const MotionContact& b) {
                      return a.key() == b.key() && a.lower == b.lower && a.upper == b.upper &&
                             a.certain == b.certain;
                    });
}

/// The same fibres, moved.
inline FiberAssembly with_points(const FiberAssembly& fibers,
                                 const std::vector<Eigen::Vector3d>& points) {
  FiberAssembly moved = fibers;
  moved.update_points(points);
  return moved;
}

inline SegmentMotions motions_of(const FiberAssembly& before, const FiberAssembly& after,
                                 PointPair pair, double margin) {
  return {&before.points()[pair.a],
          &after.points()[pair.a],
          &before.points()[pair.b],
          &after.points()[pair.b],
          {before.segment_radius(pair.a), before.segment_radius(pair.b), margin}};
}

inline std::vector<std::uint32_t> first_points(const FiberAssembly& fibers) {
  std::vector<std::uint32_t> points;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      points.push_back(i);
    }
  }
  return points;
}

/// All pairs, one by one.
inline MotionResult expected_of(const FiberAssembly& before, const FiberAssembly& after,
                                const MotionOptions& options) {
  const QueryOptions pairs = pairs_of(options);
  const NarrowPhase test(before, pairs);
  const std::vector<std::uint32_t> segments = first_points(before);
  MotionResult result;
  for (const std::uint32_t a : segments) {
    for (const std::uint32_t b : segments) {
      if (a >= b || test.is_left_out({a, b})) {
        continue;
      }
      const ContactTime time =
          contact_time(motions_of(before, after, {a, b}, options.margin), options.tolerance);
      if (time.hit && !test.lacks_loop({a, b})) {
        const SegmentId id_a = before.segment_id(a);
        const SegmentId id_b = before.segment_id(b);
        const bool touches = time.certain && time.upper == 0.0;
        (touches ? result.touching : result.contacts)
            .push_back({{id_a.fiber, id_a.segment, id_b.fiber, id_b.segment},
                        time.lower,
                        time.upper,
                        time.certain});
      }
    }
  }
  return result;
}

}  // namespace fiber::test
