#include "fiber_proximity/query/motion_judge.hpp"

#include <algorithm>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/query/contact_judge.hpp"
#include "src/query/for_each_of.hpp"

namespace fiber {
namespace {

constexpr std::size_t motions_per_slice = 512;

/// What one thread finds at a time.
struct MotionSlice {
  std::vector<MotionContact> contacts;
  std::vector<MotionContact> touching;
  bool complete = true;
};

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

/// The most contacts to report that begin during the motion, 0 for no limit.
std::size_t most_contacts(const MotionOptions& options) {
  std::size_t most = options.contact_limit;
  if (options.type != MotionType::ALL) {
    const std::size_t asked = options.type == MotionType::FIRST ? 1 : options.max_contacts;
    most = most == 0 ? asked : std::min(most, asked);
  }
  return most;
}

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
  std::sort(contacts.begin(), contacts.end(),
            [](const MotionContact& x, const MotionContact& y) { return x.key() < y.key(); });
  return true;
}

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
  result.counts = candidates.counts;
  result.counts.primitive_tests += keys.size();
  result.complete = candidates.are_all && !candidates.are_too_many;
  for (const MotionSlice& slice : slices) {
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
  const bool are_more = keep_earliest(most_contacts(options), result);
  result.limit_reached = result.limit_reached || (are_more && options.type != MotionType::FIRST);
}

}  // namespace fiber
