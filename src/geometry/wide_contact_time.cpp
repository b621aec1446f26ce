#include "src/geometry/double_double.hpp"
#include "src/geometry/segment_motion-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

using WideMotion = SegmentMotion<DoubleDouble>;
using WideState = Advancement<DoubleDouble>::State;

/// Of coordinates and limit: as those of double, with numbers that err by 2⁻¹⁰² instead of 2⁻⁵³.
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
