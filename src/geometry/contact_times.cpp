// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/geometry/contact_times.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <stdexcept>
#include <string>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/geometry/segment_distance-inl.hpp"
#include "src/geometry/segment_motion-inl.hpp"
#include "src/geometry/wide_contact_time.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

using Doubles = LaneNumber::Tag;
using Nearest = LaneDistance<Doubles>;
using Motion = SegmentMotion<double>;
using State = Advancement<double>::State;

constexpr std::size_t most_lanes = hn::MaxLanes(Doubles());

/// Of coordinates and limit (docs/numerics.md).
constexpr double roundings = 0x1p-46;

Parallelogram<LaneNumber> load(const double (&values)[12][most_lanes]) {
  const Doubles d;
  Parallelogram<LaneNumber> result;
  for (std::size_t corner = 0; corner < 4; ++corner) {
    result.corners[corner / 2][corner % 2] = {LaneNumber(hn::Load(d, values[3 * corner])),
                                              LaneNumber(hn::Load(d, values[3 * corner + 1])),
                                              LaneNumber(hn::Load(d, values[3 * corner + 2]))};
  }
  return result;
}

Nearest::Vector lanes_of(const NumberVector<LaneNumber>& vector) {
  return {vector.x.lanes, vector.y.lanes, vector.z.lanes};
}

HWY_INLINE MotionLook<LaneNumber> look_in_lanes(const Parallelogram<LaneNumber>& now,
                                                const Parallelogram<LaneNumber>& rate,
                                                LaneNumber limit, LaneNumber error) {
  const Nearest nearest({lanes_of(now.along_a()), lanes_of(now.along_b()),
                         lanes_of(now.corners[0][0]), lanes_of(now.corners[1][0]),
                         lanes_of(now.corners[0][1])});
  return look_at(now, rate, LaneNumber(nearest.s), LaneNumber(nearest.t), limit, error);
}

/// The look at time 0, which shows for most pairs that they never come into contact.
class FirstLook {
 public:
  /// @param count from 1 to the number of lanes
  FirstLook(const SegmentMotions* motions, std::size_t count) {
    for (std::size_t lane = 0; lane < hn::Lanes(Doubles()); ++lane) {
      const SegmentMotions& pair = motions[std::min(lane, count - 1)];
      read(pair.a_before, lane, a_before_);
      read(pair.a_after, lane, a_after_);
      read(pair.b_before, lane, b_before_);
      read(pair.b_after, lane, b_after_);
      limit_[lane] = pair.limit.radius_a + pair.limit.radius_b + pair.limit.margin;
    }
  }

  /// Bits of the pairs that are to be looked at more closely.
  std::uint64_t open_bits() const {
    const Doubles d;
    const LaneNumber limit(hn::Load(d, limit_));
    const Parallelogram<LaneNumber> start = differences(a_before_, b_before_);
    const Parallelogram<LaneNumber> end = differences(a_after_, b_after_);
    NumberVector<LaneNumber> least = start.corners[0][0];
    NumberVector<LaneNumber> most = least;
    Parallelogram<LaneNumber> rate;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        rate.corners[i][j] = end.corners[i][j] - start.corners[i][j];
        least = smaller(smaller(least, start.corners[i][j]), end.corners[i][j]);
        most = larger(larger(most, start.corners[i][j]), end.corners[i][j]);
      }
    }
    const LaneNumber largest = larger(larger(larger(-least.x, most.x), larger(-least.y, most.y)),
                                      larger(-least.z, most.z));
    const LaneNumber error = LaneNumber(roundings) * (largest + limit);
    const LaneNumber reach = limit + error;
    const LaneNumber gap = larger(larger(larger(least.x, -most.x), larger(least.y, -most.y)),
                                  larger(least.z, -most.z));
    const auto is_in_range = hn::And(LaneNumber(least_distance_scale) < largest,
                                     largest < LaneNumber(largest_distance_scale));
    const auto is_apart = hn::And(is_in_range, reach < gap);
    if (hn::AllTrue(d, is_apart)) {
      return 0;
    }
    const MotionLook<LaneNumber> look = look_in_lanes(start, rate, limit, error);
    const auto is_free = hn::And(is_in_range, LaneNumber(1.0) < look.free);
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, hn::Not(hn::Or(is_apart, is_free)), bits);
    return bits[0];
  }

 private:
  using Ends = double[6][most_lanes];

  static void read(const Eigen::Vector3d* ends, std::size_t lane, Ends& values) {
    const double* const coordinates = ends->data();
    for (std::size_t i = 0; i < 6; ++i) {
      values[i][lane] = coordinates[i];
    }
  }

  static NumberVector<LaneNumber> end(const Ends& values, int which) {
    const Doubles d;
    return {LaneNumber(hn::Load(d, values[3 * which])),
            LaneNumber(hn::Load(d, values[3 * which + 1])),
            LaneNumber(hn::Load(d, values[3 * which + 2]))};
  }

  static Parallelogram<LaneNumber> differences(const Ends& a, const Ends& b) {
    Parallelogram<LaneNumber> result;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        result.corners[i][j] = end(a, i) - end(b, j);
      }
    }
    return result;
  }

  alignas(64) Ends a_before_;
  alignas(64) Ends a_after_;
  alignas(64) Ends b_before_;
  alignas(64) Ends b_after_;
  alignas(64) double limit_[most_lanes];
};

/// What is looked at more closely, a pair a lane: coordinate by coordinate, then lane.
class alignas(64) LaneMotions {
 public:
  void set(std::size_t lane, const Motion& motion) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      store(motion.start.corners[corner / 2][corner % 2], 3 * corner, lane, start_);
      store(motion.rate.corners[corner / 2][corner % 2], 3 * corner, lane, rate_);
    }
    limit_[lane] = motion.limit;
    error_[lane] = motion.error;
  }

  void set_time(std::size_t lane, double time) { time_[lane] = time; }

  /// Looks at all lanes.
  void look() {
    const Doubles d;
    const Parallelogram<LaneNumber> rate = load(rate_);
    const auto now = moved(load(start_), rate, LaneNumber(hn::Load(d, time_)));
    const MotionLook<LaneNumber> look =
        look_in_lanes(now, rate, LaneNumber(hn::Load(d, limit_)), LaneNumber(hn::Load(d, error_)));
    hn::Store(look.distance.lanes, d, distance_);
    hn::Store(look.closing.lanes, d, closing_);
    hn::Store(look.free.lanes, d, free_);
  }

  MotionLook<double> look_of(std::size_t lane) const {
    return {distance_[lane], closing_[lane], free_[lane]};
  }

 private:
  using Values = double[12][most_lanes];

  static void store(const NumberVector<double>& vector, std::size_t row, std::size_t lane,
                    Values& values) {
    values[row][lane] = vector.x;
    values[row + 1][lane] = vector.y;
    values[row + 2][lane] = vector.z;
  }

  Values start_ = {};
  Values rate_ = {};
  double limit_[most_lanes] = {};
  double error_[most_lanes] = {};
  double time_[most_lanes] = {};
  double distance_[most_lanes] = {};
  double closing_[most_lanes] = {};
  double free_[most_lanes] = {};
};

bool touch_before(const SegmentMotions& pair) {
  return gap_at_most(pair.a_before[0], pair.a_before[1], pair.b_before[0], pair.b_before[1],
                     pair.limit);
}

constexpr std::size_t pairs_at_a_time = 256;

/// Some pairs that may come into contact, as many at a time as there are lanes: where one has come
/// to its end, the next begins.
class ContactTimes {
 public:
  ContactTimes(const SegmentMotions* motions, double tolerance, ContactTime* times)
      : motions_(motions), tolerance_(tolerance), times_(times) {}

  void add(std::size_t pair) { pairs_[count_++] = pair; }

  void find() {
    const std::size_t lanes = hn::Lanes(Doubles());
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      begin(lane);
    }
    while (busy_count_ > 0) {
      lanes_.look();
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        if (ways_[lane].is_busy && !go_on(lane)) {
          --busy_count_;
          begin(lane);
        }
      }
    }
  }

 private:
  /// A pair that is on its way, in a lane.
  struct Way {
    Motion motion;
    Advancement<double> advancement;
    std::size_t pair = 0;
    bool is_busy = false;
  };

  /// Puts the next pair into a lane, if there is one.
  void begin(std::size_t lane) {
    Way& way = ways_[lane];
    way.is_busy = next_ < count_;
    if (way.is_busy) {
      way.pair = pairs_[next_++];
      way.motion = Motion(motions_[way.pair], tolerance_, roundings);
      way.advancement = Advancement<double>(0.0, false);
      lanes_.set(lane, way.motion);
      lanes_.set_time(lane, 0.0);
      ++busy_count_;
    }
  }

  /// Takes what has been seen in a lane; whether it wants another look.
  bool go_on(std::size_t lane) {
    Way& way = ways_[lane];
    ContactTime& result = times_[way.pair];
    const MotionLook<double> look = lanes_.look_of(lane);
    if (way.advancement.time() == 0.0 && !(look.free > 0.0) && touch_before(motions_[way.pair])) {
      result = {true, 0.0, 0.0, true};
      return false;
    }
    way.advancement.take(way.motion, look);
    switch (way.advancement.state()) {
      case State::DONE:
        result = way.advancement.result();
        return false;
      case State::UNDECIDED:
        result = wide_contact_time(motions_[way.pair], tolerance_, way.advancement.time());
        return false;
      default:
        lanes_.set_time(lane, way.advancement.time());
        return true;
    }
  }

  LaneMotions lanes_;
  const SegmentMotions* const motions_;
  const double tolerance_;  // [m]
  ContactTime* const times_;
  Way ways_[most_lanes];
  std::size_t pairs_[pairs_at_a_time];
  std::size_t count_ = 0;
  std::size_t next_ = 0;
  std::size_t busy_count_ = 0;
};

void contact_times_lanes(const SegmentMotions* motions, std::size_t count, double tolerance,
                         ContactTime* times) {
  const std::size_t lanes = hn::Lanes(Doubles());
  for (std::size_t begin = 0; begin < count; begin += pairs_at_a_time) {
    const std::size_t end = std::min(count, begin + pairs_at_a_time);
    ContactTimes open(motions, tolerance, times);
    for (std::size_t first = begin; first < end; first += lanes) {
      const std::size_t size = std::min(lanes, end - first);
      std::uint64_t bits = FirstLook(motions + first, size).open_bits();
      for (std::size_t lane = 0; lane < size; ++lane, bits >>= 1U) {
        times[first + lane] = ContactTime();
        if ((bits & 1U) != 0) {
          open.add(first + lane);
        }
      }
    }
    open.find();
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(contact_times_lanes);

void contact_times(const SegmentMotions* motions, std::size_t count, double tolerance,
                   ContactTime* times) {
  if (!(tolerance >= 0.0)) {
    throw std::invalid_argument("the tolerance of contact times is " + std::to_string(tolerance) +
                                " m, it must be a number and not negative");
  }
  HWY_DYNAMIC_DISPATCH(contact_times_lanes)(motions, count, tolerance, times);
}

ContactTime contact_time(const SegmentMotions& motions, double tolerance) {
  ContactTime time;
  contact_times(&motions, 1, tolerance, &time);
  return time;
}

}  // namespace fiber
#endif
