#include "src/query/motion_evaluator.hpp"

#include <algorithm>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/query/contact_evaluator.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

/// Leaves the earliest ones, sorted by key.
/// @return whether there were more
bool keep_earliest(std::size_t most, MotionResult& result) {
  std::vector<MotionContact>& contacts = result.contacts;
  if (most == 0 || contacts.size() <= most) {
    return false;
  }
  std::nth_element(
      contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(most), contacts.end(),
      [](const MotionContact& x, const MotionContact& y) { return x.earlier_than(y); });
  result.others_lower = std::min(result.others_lower, contacts[most].lower);
  contacts.resize(most);
  std::sort(contacts.begin(), contacts.end(), by_key);
  return true;
}

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
      motions[i] = motions_of(a_, b_, pair_of(keys[i]), options_.margin);
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
  MotionContact contact(PointPair pair, const ContactTime& time) const {
    const SegmentId id_a = a_.before.segment_id(pair.a);
    const SegmentId id_b = b_.before.segment_id(pair.b);
    return {
        {id_a.fiber, id_a.segment, id_b.fiber, id_b.segment}, time.lower, time.upper, time.certain};
  }

  const FiberMotion& a_;
  const FiberMotion& b_;
  const NarrowPhase& test_;
  const MotionOptions& options_;
};

}  // namespace

std::size_t max_reported(const MotionOptions& options) {
  std::size_t most = options.contact_limit;
  if (options.type != MotionType::ALL) {
    const std::size_t asked = options.type == MotionType::FIRST ? 1 : options.max_contacts;
    most = most == 0 ? asked : std::min(most, asked);
  }
  return most;
}

void merge_slices(const MotionSlice* slices, std::size_t count, const MotionCandidates& candidates,
                  const MotionOptions& options, MotionResult& result) {
  result.counts = candidates.counts;
  result.counts.primitive_tests += candidates.keys.size();
  result.complete = candidates.are_all && !candidates.are_too_many;
  for (std::size_t i = 0; i < count; ++i) {
    const MotionSlice& slice = slices[i];
    result.contacts.insert(result.contacts.end(), slice.contacts.begin(), slice.contacts.end());
    result.touching.insert(result.touching.end(), slice.touching.begin(), slice.touching.end());
    result.complete = result.complete && slice.complete;
  }
  result.others_lower = result.complete ? 1.0 : 0.0;
  result.limit_reached = candidates.are_too_many;
  if (options.contact_limit > 0 && result.touching.size() > options.contact_limit) {
    result.touching.resize(options.contact_limit);
    result.others_lower = 0.0;
    result.limit_reached = true;
  }
  const bool are_more = keep_earliest(max_reported(options), result);
  result.limit_reached = result.limit_reached || (are_more && options.type != MotionType::FIRST);
}

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
