#include "fiber_proximity/query/motion_evaluator.hpp"

#include <algorithm>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/query/contact_evaluator.hpp"
#include "src/query/for_each_of.hpp"
#include "src/query/narrow_contact_time.hpp"

namespace fiber {
namespace {

// Motions are judged in rounds, so that their times take little memory.
constexpr std::size_t motion_slices_per_round = 32;

/// Which motions are asked about, and what of each is reported.
class MotionTest {
 public:
  MotionTest(const FiberMotion& a, const FiberMotion& b, const NarrowPhase& test,
             const MotionOptions& options)
      : a_(a), b_(b), test_(test), options_(options) {}

  /// @param count at most that of a slice
  /// @param times found, as many
  void report(const std::uint64_t* keys, std::size_t count, ContactTime* times,
              MotionSlice& slice) const {
    SegmentMotions motions[motions_per_slice];
    for (std::size_t i = 0; i < count; ++i) {
      motions[i] = motions_of(pair_of(keys[i]));
    }
    contact_times(motions, count, options_.tolerance, times);
    for (std::size_t i = 0; i < count; ++i) {
      const PointPair pair = pair_of(keys[i]);
      narrow(times[i], options_,
             [&](double tolerance) { return contact_time(motions[i], tolerance); });
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
  const NarrowPhase& test_;
  const MotionOptions& options_;
};

}  // namespace

void MotionEvaluator::evaluate(const MotionCandidates& candidates, const FiberMotion& a,
                               const FiberMotion& b, const NarrowPhase& test,
                               const MotionOptions& options, const QueryLimits& limits,
                               MotionResult& result) {
  const std::vector<std::uint64_t>& keys = candidates.keys;
  const MotionTest motions(a, b, test, options);
  const std::size_t count = (keys.size() + motions_per_slice - 1) / motions_per_slice;
  slices_.resize(std::max(slices_.size(), count));
  times_.resize(
      std::max(times_.size(), std::min(count, motion_slices_per_round) * motions_per_slice));
  for (std::size_t round = 0; round < count; round += motion_slices_per_round) {
    for_each_of(std::min(motion_slices_per_round, count - round), [&](std::size_t index) {
      MotionSlice& slice = slices_[round + index];
      slice.contacts.clear();
      slice.touching.clear();
      slice.complete = !limits.deadline.has_passed();
      if (slice.complete) {
        const std::size_t first = (round + index) * motions_per_slice;
        motions.report(keys.data() + first, std::min(motions_per_slice, keys.size() - first),
                       times_.data() + index * motions_per_slice, slice);
      }
    });
  }
  merge_slices(slices_.data(), count, candidates, options, result);
}

}  // namespace fiber
