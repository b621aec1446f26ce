#include "fiber_proximity/query/motion_judge.hpp"

#include <algorithm>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/query/contact_judge.hpp"
#include "src/query/for_each_of.hpp"

namespace fiber {
namespace {

class MotionJudge {
 public:
  MotionJudge(const FiberMotion& a, const FiberMotion& b, const PairTest& test,
              const MotionOptions& options, const QueryLimits& limits)
      : a_(a), b_(b), test_(test), options_(options), limits_(limits) {}

  void judge(const std::uint64_t* keys, std::size_t count, MotionSlice& slice) const {
    slice.complete = !limits_.deadline.has_passed();
    if (!slice.complete) {
      return;
    }
    SegmentMotions motions[motions_per_slice];
    std::vector<ContactTime> times(count);
    for (std::size_t i = 0; i < count; ++i) {
      motions[i] = motions_of(pair_of(keys[i]));
    }
    contact_times(motions, count, options_.tolerance, times.data());
    for (std::size_t i = 0; i < count; ++i) {
      const PointPair pair = pair_of(keys[i]);
      // Few come so far: whether a fibre makes a loop costs more than when it has contact.
      if (times[i].hit && !test_.lacks_loop(pair)) {
        (is_there_before(times[i]) ? slice.touching : slice.contacts)
            .push_back(contact(pair, times[i]));
      }
    }
  }

 private:
  static bool is_there_before(const ContactTime& time) { return time.certain && time.upper == 0.0; }

  static double larger_radius(const FiberMotion& motion, std::uint32_t point) {
    return std::max(motion.before.segment_radius(point), motion.after.segment_radius(point));
  }

  SegmentMotions motions_of(PointPair pair) const {
    return {&a_.before.points()[pair.a],
            &a_.after.points()[pair.a],
            &b_.before.points()[pair.b],
            &b_.after.points()[pair.b],
            {larger_radius(a_, pair.a), larger_radius(b_, pair.b), options_.margin}};
  }

  MotionContact contact(PointPair pair, const ContactTime& time) const {
    const SegmentId id_a = a_.before.segment_id(pair.a);
    const SegmentId id_b = b_.before.segment_id(pair.b);
    return {id_a.fiber, id_a.segment, id_b.fiber,  id_b.segment,
            time.lower, time.upper,   time.certain};
  }

  const FiberMotion& a_;
  const FiberMotion& b_;
  const PairTest& test_;
  const MotionOptions& options_;
  const QueryLimits& limits_;
};

}  // namespace

void judge_motion(const MotionCandidates& candidates, const FiberMotion& a, const FiberMotion& b,
                  const PairTest& test, const MotionOptions& options, const QueryLimits& limits,
                  MotionResult& result) {
  const std::vector<std::uint64_t>& keys = candidates.keys;
  const MotionJudge judge(a, b, test, options, limits);
  std::vector<MotionSlice> slices((keys.size() + motions_per_slice - 1) / motions_per_slice);
  for_each_of(slices.size(), [&](std::size_t index) {
    const std::size_t begin = index * motions_per_slice;
    judge.judge(keys.data() + begin, std::min(motions_per_slice, keys.size() - begin),
                slices[index]);
  });
  merge_slices(slices, candidates, options, result);
}

}  // namespace fiber
