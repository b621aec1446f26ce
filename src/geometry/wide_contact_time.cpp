#include "src/geometry/wide_contact_time.hpp"

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

Eigen::Vector3d rounded_corner(const NumberVector<DoubleDouble>& vector) {
  return {vector.x.high, vector.y.high, vector.z.high};
}

DoubleDouble clamped_parameter(DoubleDouble parameter) {
  return parameter.high < 0.0 ? DoubleDouble(0.0) : smaller(parameter, DoubleDouble(1.0));
}

/// Parameters of the nearest points: robust ones tell which ends they are or whose inside, the
/// rest is computed anew.
struct WideParameters {
  DoubleDouble s;
  DoubleDouble t;

  explicit WideParameters(const Parallelogram<DoubleDouble>& now) {
    const NumberVector<DoubleDouble> u = now.along_a();
    const NumberVector<DoubleDouble> v = now.along_b();
    const NumberVector<DoubleDouble>& w = now.corners[0][0];
    const SegmentDistance robust =
        segment_distance(rounded_corner(w), rounded_corner(now.corners[1][0]),
                         Eigen::Vector3d::Zero(), rounded_corner(v));
    s = DoubleDouble(robust.s);
    t = DoubleDouble(robust.t);
    const bool on_a = robust.s > 0.0 && robust.s < 1.0;
    const bool on_b = robust.t > 0.0 && robust.t < 1.0;
    const NumberVector<DoubleDouble> normal = cross(u, v);
    const DoubleDouble squared = dot(normal, normal);
    if (on_a && on_b && squared.high > 0.0) {
      s = clamped_parameter(dot(cross(v, w), normal) / squared);
      t = clamped_parameter(dot(cross(u, w), normal) / squared);
    } else if (on_b && dot(v, v).high > 0.0) {
      t = clamped_parameter(dot(w + s * u, v) / dot(v, v));
    } else if (on_a && dot(u, u).high > 0.0) {
      s = clamped_parameter(dot(t * v - w, u) / dot(u, u));
    }
  }
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
