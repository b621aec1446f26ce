// Compiled once per instruction set; Highway chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/geometry/contact_times.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include <stdexcept>
#include <string>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/geometry/double_double.hpp"
#include "src/geometry/motion_lanes-inl.hpp"
#include "src/geometry/segment_motion-inl.hpp"

namespace fiber {

/// contact_time() in numbers of twice the digits, from a time until which there is no contact.
// Read for each instruction set. NOLINTNEXTLINE(readability-redundant-declaration)
ContactTime wide_contact_time(const SegmentMotions& motions, double tolerance, double time);

}  // namespace fiber

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

using Motion = SegmentMotion<double>;
using State = Advancement<double>::State;

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

  /// @param look at time 0
  void add(std::size_t pair, const MotionLook<double>& look) { open_[count_++] = {pair, look}; }

  void find() {
    const std::size_t lanes = hn::Lanes(MotionTag());
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      begin(lane);
    }
    while (busy_count_ > 0) {
      lanes_.look();
      for (std::size_t lane = 0; lane < lanes; ++lane) {
        FollowedPair& followed = followed_[lane];
        if (followed.is_busy && !go_on(followed, lanes_.look_of(lane))) {
          --busy_count_;
          begin(lane);
        } else {
          lanes_.set_time(lane, followed.advancement.time());
        }
      }
    }
  }

 private:
  /// A pair that is being followed, in a lane.
  struct FollowedPair {
    Motion motion;
    Advancement<double> advancement;
    std::size_t pair = 0;
    bool is_busy = false;
  };

  struct OpenPair {
    std::size_t pair;
    MotionLook<double> look;  // at time 0
  };

  /// Puts the next pair into a lane that wants another look, if there is one.
  void begin(std::size_t lane) {
    FollowedPair& followed = followed_[lane];
    followed.is_busy = false;
    while (!followed.is_busy && next_ < count_) {
      const OpenPair& open = open_[next_++];
      followed.pair = open.pair;
      followed.motion = Motion(motions_[followed.pair], tolerance_, motion_roundings);
      followed.advancement = Advancement<double>(0.0, false);
      followed.is_busy = go_on(followed, open.look);
    }
    if (followed.is_busy) {
      lanes_.set(lane, followed.motion);
      lanes_.set_time(lane, followed.advancement.time());
      ++busy_count_;
    }
  }

  /// Takes what has been seen of a pair; whether it wants another look.
  bool go_on(FollowedPair& followed, const MotionLook<double>& look) {
    ContactTime& result = times_[followed.pair];
    if (followed.advancement.time() == 0.0 && !(look.free > 0.0) &&
        touch_before(motions_[followed.pair])) {
      result = {true, 0.0, 0.0, true};
      return false;
    }
    followed.advancement.take(followed.motion, look);
    switch (followed.advancement.state()) {
      case State::DONE:
        result = followed.advancement.result();
        return false;
      case State::UNDECIDED:
        result =
            wide_contact_time(motions_[followed.pair], tolerance_, followed.advancement.time());
        return false;
      default:
        return true;
    }
  }

  LaneMotions lanes_;
  const SegmentMotions* const motions_;
  const double tolerance_;  // [m]
  ContactTime* const times_;
  FollowedPair followed_[max_motion_lanes];
  OpenPair open_[pairs_at_a_time];
  std::size_t count_ = 0;
  std::size_t next_ = 0;
  std::size_t busy_count_ = 0;
};

void contact_times_lanes(const SegmentMotions* motions, std::size_t count, double tolerance,
                         ContactTime* times) {
  const std::size_t lanes = hn::Lanes(MotionTag());
  for (std::size_t begin = 0; begin < count; begin += pairs_at_a_time) {
    const std::size_t end = std::min(count, begin + pairs_at_a_time);
    ContactTimes open(motions, tolerance, times);
    for (std::size_t first = begin; first < end; first += lanes) {
      const std::size_t size = std::min(lanes, end - first);
      FirstLook look(motions + first, size);
      const FirstLook::Seen seen = look.look();
      for (std::size_t lane = 0; lane < size; ++lane) {
        const bool is_touching = (seen.touching >> lane & 1U) != 0;
        times[first + lane] = is_touching ? ContactTime{true, 0.0, 0.0, true} : ContactTime();
        if ((seen.open >> lane & 1U) != 0) {
          open.add(first + lane, look.look_of(lane));
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
HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

using WideMotion = SegmentMotion<DoubleDouble>;
using WideState = Advancement<DoubleDouble>::State;

/// A part of coordinates and limit, as those of double are, with numbers that err by 2⁻¹⁰² instead
/// of 2⁻⁵³.
constexpr double wide_roundings = 0x1p-94;

using WideVector = NumberVector<DoubleDouble>;

const DoubleDouble wide_zero(0.0);
const DoubleDouble wide_one(1.0);

/// Parameter of the projection of a point at `offset` from a segment's start.
DoubleDouble wide_projection(const WideVector& offset, const WideVector& direction) {
  const DoubleDouble along = dot(offset, direction);
  const DoubleDouble squared_length = dot(direction, direction);
  if (!(wide_zero < along)) {
    return wide_zero;
  }
  return along < squared_length ? along / squared_length : wide_one;
}

/// Parameters of the nearest points: the best of the candidates of segment_distance().
struct WideParameters {
  DoubleDouble s;
  DoubleDouble t;

  explicit WideParameters(const Parallelogram<DoubleDouble>& now) {
    const WideVector u = now.along_a();
    const WideVector v = now.along_b();
    const auto& corners = now.corners;
    const WideVector& w = corners[0][0];
    const WideVector none{wide_zero, wide_zero, wide_zero};
    consider(now, wide_zero, wide_projection(w, v));
    consider(now, wide_one, wide_projection(corners[1][0], v));
    consider(now, wide_projection(none - w, u), wide_zero);
    consider(now, wide_projection(none - corners[0][1], u), wide_one);
    const WideVector normal = cross(u, v);
    const DoubleDouble squared = dot(normal, normal);
    const DoubleDouble s_inside = dot(cross(v, w), normal);
    const DoubleDouble t_inside = dot(cross(u, w), normal);
    if (wide_zero < s_inside && s_inside < squared && wide_zero < t_inside && t_inside < squared) {
      consider(now, s_inside / squared, t_inside / squared);
    }
  }

 private:
  void consider(const Parallelogram<DoubleDouble>& now, DoubleDouble other_s,
                DoubleDouble other_t) {
    const WideVector between = now.between(other_s, other_t);
    const DoubleDouble squared = dot(between, between);
    if (!has_any_ || squared < squared_) {
      s = other_s;
      t = other_t;
      squared_ = squared;
      has_any_ = true;
    }
  }

  DoubleDouble squared_;
  bool has_any_ = false;
};

}  // namespace
}  // namespace HWY_NAMESPACE

ContactTime wide_contact_time(const SegmentMotions& motions, double tolerance, double time) {
  using namespace HWY_NAMESPACE;  // NOLINT(google-build-using-namespace)
  const WideMotion motion(motions, tolerance, wide_roundings);
  Advancement<DoubleDouble> advancement(time, true);
  do {
    const auto now = moved(motion.start, motion.rate, DoubleDouble(advancement.time()));
    const WideParameters nearest(now);
    advancement.take(motion,
                     look_at(now, motion.rate, nearest.s, nearest.t, motion.limit, motion.error));
  } while (advancement.state() != WideState::DONE);
  return advancement.result();
}

}  // namespace fiber
HWY_AFTER_NAMESPACE();

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
