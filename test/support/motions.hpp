#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/for_engines/narrow_phase.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "test/support/assemblies.hpp"

namespace fiber::test {

/// Bit by bit.
inline bool same(const std::vector<MotionContact>& x, const std::vector<MotionContact>& y) {
  return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                    [](const MotionContact& a, const MotionContact& b) {
                      return a.key() == b.key() && a.lower == b.lower && a.upper == b.upper &&
                             a.certain == b.certain;
                    });
}

inline SegmentMotions motions_of(const FiberAssembly& before, const FiberAssembly& after,
                                 PointPair pair, double margin) {
  return {&before.points()[pair.a],
          &after.points()[pair.a],
          &before.points()[pair.b],
          &after.points()[pair.b],
          {before.segment_radius(pair.a), before.segment_radius(pair.b), margin}};
}

/// Of an engine of this name.
inline MotionResult answer(const std::string& name, const FiberAssembly& before,
                           const FiberAssembly& after, const MotionOptions& options,
                           std::uint32_t threads = 0) {
  const std::unique_ptr<ProximityEngine> engine = make_engine(name, {threads});
  MotionResult result;
  engine->update_motion(before, after);
  engine->query_motion(options, result);
  return result;
}

/// All pairs, one by one.
inline MotionResult expected_of(const FiberAssembly& before, const FiberAssembly& after,
                                const MotionOptions& options) {
  const QueryOptions pairs = pairs_of(options);
  const NarrowPhase test(before, pairs);
  const std::vector<std::uint32_t> segments = segments_of(before);
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
