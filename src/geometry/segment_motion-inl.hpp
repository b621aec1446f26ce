// Follows one pair of moving segments from time 0 to its contact. Included once per instruction
// set, so it has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_SEGMENT_MOTION_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SEGMENT_MOTION_INL
#undef FIBER_SEGMENT_MOTION_INL
#else
#define FIBER_SEGMENT_MOTION_INL
#endif

#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/geometry/moving_parallelogram-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

/// Than all corners in the units that they are computed in, and no infinity.
constexpr double longest_limit = 0x1p1000;

/// The factor of all lengths, a power of two: 1 where fourth powers of the largest
/// coordinate stay in the range of double.
inline double scale_of(double largest) {
  if (largest == 0.0 || (largest > min_distance_scale && largest < largest_distance_scale)) {
    return 1.0;
  }
  constexpr int largest_exponent = 1000;
  return std::ldexp(1.0, std::min(-std::ilogb(largest), largest_exponent));
}

/// The question to contact_time(), in numbers of this kind. Lengths are in metres, or where fourth
/// powers of these leave the range of double, in a power of two of them.
template <class Number>
class SegmentMotion {
 public:
  Parallelogram<Number> start;
  Parallelogram<Number> rate;
  Number limit;  ///< the distance of a contact
  Number tolerance;
  Number error;  ///< of all that is computed of it (docs/numerics.md)

  SegmentMotion() = default;

  /// @param roundings the error, as a part of the largest coordinate and what the limit is made of
  SegmentMotion(const SegmentMotions& motions, double tolerance_in_metres, double roundings)
      : limit(motions.limit.sum<Number>()),
        tolerance(tolerance_in_metres),
        parts_(motions.limit.parts<Number>()) {
    min_ = difference(motions.a_before[0], motions.b_before[0]);
    max_ = min_;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        start.corners[i][j] = difference(motions.a_before[i], motions.b_before[j]);
        const Vector end = difference(motions.a_after[i], motions.b_after[j]);
        rate.corners[i][j] = end - start.corners[i][j];
        enclose(start.corners[i][j]);
        enclose(end);
      }
    }
    if (const double factor = scale_of(static_cast<double>(largest())); factor != 1.0) {
      scale(factor);
    }
    error = Number(roundings) * (largest() + parts_);
  }

 private:
  using Vector = NumberVector<Number>;

  void enclose(const Vector& corner) {
    min_ = smaller(corner, min_);
    max_ = larger(corner, max_);
  }

  /// The largest magnitude of a coordinate.
  Number largest() const {
    const Vector magnitudes = larger(Number(-1.0) * min_, max_);
    return larger(magnitudes.x, larger(magnitudes.y, magnitudes.z));
  }

  void scale(double factor) {
    const Number unit(factor);
    for (Parallelogram<Number>* shape : {&start, &rate}) {
      for (auto& row : shape->corners) {
        row[0] = unit * row[0];
        row[1] = unit * row[1];
      }
    }
    for (Number* length : {&limit, &tolerance, &parts_}) {
      *length = smaller(unit * *length, Number(longest_limit));
    }
    min_ = unit * min_;
    max_ = unit * max_;
  }

  static Vector difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return Vector{Number(a.x()), Number(a.y()), Number(a.z())} -
           Vector{Number(b.x()), Number(b.y()), Number(b.z())};
  }

  Number parts_;  // which the limit is rounded by a part of
  Vector min_;    // of all corners, before and after
  Vector max_;
};

/// Whether two segments surely cross between two times: the volume that they span changes its sign,
/// and until then their lines cross inside both.
template <class Number>
bool surely_cross(const SegmentMotion<Number>& motion, const Number& from, const Number& to) {
  const auto first = moved(motion.start, motion.rate, from);
  const auto last = moved(motion.start, motion.rate, to);
  const NumberVector<Number> u = first.along_a();
  const NumberVector<Number> v = first.along_b();
  const NumberVector<Number>& w = first.corners[0][0];
  const NumberVector<Number> normal = cross(u, v);
  const NumberVector<Number> last_normal = cross(last.along_a(), last.along_b());
  const Number volume = dot(w, normal);
  const Number last_volume = dot(last.corners[0][0], last_normal);

  // No vector differs by more than `change` from what it is at the first time, its error included.
  const Number error = Number(4.0) * motion.error;
  const Number change = length_of(last.along_a() - u) + length_of(last.along_b() - v) +
                        length_of(last.corners[0][0] - w) + error;
  const Number max_u = length_of(u) + change;
  const Number max_v = length_of(v) + change;
  const Number max_w = length_of(w) + change;
  const Number volume_error = Number(4.0) * error * (max_u * max_v + max_w * (max_u + max_v));
  const Number length = length_of(normal);
  const Number normal_change = change * (max_u + max_v);
  const Number max_length = length + normal_change;
  const Number squared = dot(normal, normal);
  const Number squared_change = normal_change * (length + max_length);
  const Number s = dot(cross(v, w), normal);
  const Number t = dot(cross(u, w), normal);
  const Number s_change = change * (max_v + max_w) * max_length + max_v * max_w * normal_change;
  const Number t_change = change * (max_u + max_w) * max_length + max_u * max_w * normal_change;
  const Number zero(0.0);
  const bool changes_sign = (volume_error < volume && last_volume < -volume_error) ||
                            (volume < -volume_error && volume_error < last_volume);
  return changes_sign && s_change < s && t_change < t && s_change + squared_change < squared - s &&
         t_change + squared_change < squared - t && zero < squared - squared_change;
}

/// Goes from time to time as far as there is surely no contact, then looks for a time at which
/// there surely is one. Times are doubles, whatever the numbers are.
template <class Number>
class Advancement {
 public:
  enum class State {
    ADVANCES,   ///< wants a look at time()
    PROBES,     ///< does, too: there is a result, which may become a certain one
    DONE,       ///< there is a result
    UNDECIDED,  ///< these numbers do not tell whether there is contact at time()
  };

  Advancement() = default;

  /// @param time until which there is no contact
  /// @param is_last whether there are no better numbers, so that it never ends undecided
  explicit Advancement(double time, bool is_last) : time_(time), is_last_(is_last) {}

  State state() const { return state_; }
  double time() const { return time_; }
  const ContactTime& result() const { return result_; }

  /// Takes a look at the pair at time().
  void take(const SegmentMotion<Number>& motion, const MotionLook<Number>& look) {
    const Number upper = look.distance + motion.error;
    const bool is_contact = !(motion.limit < upper);
    const Number tolerance = Number(1.0 - 0x1p-51) * motion.tolerance;
    const bool is_near = is_contact || upper < motion.limit + tolerance;
    ++looks_;
    if (state_ == State::PROBES) {
      probe(motion, look, is_near, is_contact);
    } else {
      advance(motion, look, is_near, is_contact);
    }
  }

 private:
  // Grazing motions take the most looks: 65 have been seen.
  static constexpr std::uint32_t max_looks = 256;
  static constexpr std::uint32_t max_probes = 4;
  static constexpr std::uint32_t max_near_looks = 1;

  void advance(const SegmentMotion<Number>& motion, const MotionLook<Number>& look, bool is_near,
               bool is_contact) {
    const double until = time_after(time_, look.free);
    if (until >= 1.0) {
      result_ = ContactTime();
      state_ = State::DONE;
    } else if (is_near) {
      result_ = {true, time_, time_, is_contact};
      if (until > time_ && near_looks_++ < max_near_looks) {
        time_ = until;  // so little is left that it pays to see more of it
      } else {
        go_on_from(motion, look, is_contact);
      }
    } else if (until > time_ && looks_ < max_looks) {
      time_ = until;
    } else if (until > time_ || is_last_) {
      result_ = {true, time_, std::numeric_limits<double>::infinity(), false};
      go_on_from(motion, look, is_contact);
    } else {
      state_ = State::UNDECIDED;
    }
  }

  void probe(const SegmentMotion<Number>& motion, const MotionLook<Number>& look, bool is_near,
             bool is_contact) {
    result_.certain = is_contact || (is_near && crosses_before(motion, look));
    if (result_.certain || (is_near && time_ < result_.upper)) {
      result_.upper = time_;
    }
    go_on_from(motion, look, result_.certain);
  }

  /// Whether segments without thickness have crossed: since some time before, as far from the
  /// crossing as now, where it is sure which side they are on.
  bool crosses_before(const SegmentMotion<Number>& motion, const MotionLook<Number>& look) const {
    if (Number(0.0) < motion.limit) {
      return false;
    }
    const Number since = Number(time_) - (look.distance + look.distance) / speed_;
    return Number(0.0) < since && surely_cross(motion, since, Number(time_));
  }

  /// Looks for a certain contact a little later: where at this speed they were half the tolerance
  /// nearer than they need be. Where they graze each other they do not come as near: less, then.
  void go_on_from(const SegmentMotion<Number>& motion, const MotionLook<Number>& look,
                  bool is_certain) {
    state_ = State::DONE;
    if (is_certain || probes_ == max_probes) {
      return;
    }
    if (probes_ == 0 || Number(0.0) < look.closing) {
      from_ = time_;
      gap_ = look.distance - motion.limit;
      speed_ = look.closing;
    }
    depth_ = probes_ == 0 ? Number(0.5) * motion.tolerance : Number(0x1p-10) * depth_;
    ++probes_;
    const double next = later(from_, (gap_ + depth_ + Number(4.0) * motion.error) / speed_);
    if (next > from_ && from_ < 1.0) {
      time_ = std::min(next, 1.0);
      state_ = State::PROBES;
    }
  }

  /// The last double before time + free.
  static double time_after(double time, double free) { return time + free - 0x1p-53; }
  static double time_after(double time, DoubleDouble free) {
    const DoubleDouble sum = DoubleDouble(time) + free;
    return sum.low < 0.0 ? std::nextafter(sum.high, 0.0) : sum.high;
  }

  /// The time that much later, but at least the next one; the time itself where it is not later.
  static double later(double time, const Number& wait) {
    if (!(Number(0.0) < wait && wait < Number(1.0))) {
      return time;
    }
    return std::max(std::nextafter(time, 2.0), static_cast<double>(Number(time) + wait));
  }

  State state_ = State::ADVANCES;
  double time_ = 0.0;
  bool is_last_ = false;
  std::uint32_t looks_ = 0;
  std::uint32_t near_looks_ = 0;
  std::uint32_t probes_ = 0;
  Number depth_ = Number(0.0);  // that probes look for
  double from_ = 0.0;           // the time of the last look at which the segments came nearer,
  Number gap_ = Number(0.0);    // what was seen then,
  Number speed_ = Number(0.0);  // and how fast they did
  ContactTime result_;
};

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();
#endif
