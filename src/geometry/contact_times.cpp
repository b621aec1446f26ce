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

/// What is looked at, a pair a lane: coordinate by coordinate, then lane.
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
    const Nearest nearest(differences(now));
    const MotionLook<LaneNumber> look =
        look_at(now, rate, LaneNumber(nearest.s), LaneNumber(nearest.t),
                LaneNumber(hn::Load(d, limit_)), LaneNumber(hn::Load(d, error_)));
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

  static Parallelogram<LaneNumber> load(const Values& values) {
    const Doubles d;
    Parallelogram<LaneNumber> result;
    for (std::size_t corner = 0; corner < 4; ++corner) {
      result.corners[corner / 2][corner % 2] = {LaneNumber(hn::Load(d, values[3 * corner])),
                                                LaneNumber(hn::Load(d, values[3 * corner + 1])),
                                                LaneNumber(hn::Load(d, values[3 * corner + 2]))};
    }
    return result;
  }

  static Nearest::Vector lanes_of(const NumberVector<LaneNumber>& vector) {
    return {vector.x.lanes, vector.y.lanes, vector.z.lanes};
  }
  static Nearest::Differences differences(const Parallelogram<LaneNumber>& now) {
    return {lanes_of(now.along_a()), lanes_of(now.along_b()), lanes_of(now.corners[0][0]),
            lanes_of(now.corners[1][0]), lanes_of(now.corners[0][1])};
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

/// All pairs, as many at a time as there are lanes: where one has come to its end, the next begins.
class ContactTimes {
 public:
  ContactTimes(const SegmentMotions* motions, std::size_t count, double tolerance,
               ContactTime* times)
      : motions_(motions), count_(count), tolerance_(tolerance), times_(times) {}

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

  /// Puts the next pair that needs a look into a lane.
  void begin(std::size_t lane) {
    Way& way = ways_[lane];
    way.is_busy = false;
    for (; next_ < count_ && !way.is_busy; ++next_) {
      way.motion = Motion(motions_[next_], tolerance_, roundings);
      way.is_busy = !way.motion.is_apart();
      times_[next_] = ContactTime();
      way.pair = next_;
    }
    if (way.is_busy) {
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

  const SegmentMotions* const motions_;
  const std::size_t count_;
  const double tolerance_;  // [m]
  ContactTime* const times_;
  LaneMotions lanes_;
  Way ways_[most_lanes];
  std::size_t busy_count_ = 0;
  std::size_t next_ = 0;
};

void contact_times_lanes(const SegmentMotions* motions, std::size_t count, double tolerance,
                         ContactTime* times) {
  ContactTimes(motions, count, tolerance, times).find();
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
