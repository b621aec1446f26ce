#include <algorithm>
#include <cmath>
#include <limits>

#include "src/environment/shape_contact_time.hpp"
#include "src/geometry/norm.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// Both exact.
struct TimeSpan {
  double begin;
  double size;

  double end() const { return begin + size; }
  TimeSpan first_half() const { return {begin, 0.5 * size}; }
  TimeSpan second_half() const { return {begin + 0.5 * size, 0.5 * size}; }
};

class ShapeMotion {
 public:
  ShapeMotion(const SegmentAndShape& pair, double distance, double tolerance)
      : shape_(pair.shape),
        path_(pair.path),
        before_{pair.before.p0, pair.before.p1},
        ways_{pair.after.p0 - pair.before.p0, pair.after.p1 - pair.before.p1},
        distance_(distance),
        tolerance_(tolerance) {
    constexpr double rounding = 0x1p-46;  // of coordinates, of moving and turning into a frame
    double largest = shape_.pose.translation().cwiseAbs().maxCoeff() +
                     shape_.in_object.translation().cwiseAbs().maxCoeff();
    for (int i = 0; i < 2; ++i) {
      largest += before_[i].cwiseAbs().maxCoeff() + ways_[i].cwiseAbs().maxCoeff();
    }
    if (path_ != nullptr) {
      largest += path_->way().cwiseAbs().maxCoeff();
    }
    error_ = rounding * largest;
  }

  ContactTime first_in(const TimeSpan& span) const {
    constexpr double part = 0.25;  // of the tolerance, for the way not being straight
    constexpr double min_size = 0x1p-24;
    const double deviation = deviation_in(span);
    ContactTime time =
        contact_time(shape_.shape, motion_in(span), {distance_, error_ + deviation}, tolerance_);
    if (!time.hit || !turns() || deviation <= part * tolerance_) {
      time.lower = time.hit ? std::max(0.0, span.begin + span.size * time.lower - 0x1p-53) : 1.0;
      time.upper = std::min(span.begin + span.size * time.upper, upper_end(time));
      return time;
    }
    if (span.size <= min_size) {
      return {true, span.begin, std::numeric_limits<double>::infinity(), false};
    }
    const ContactTime first = first_in(span.first_half());
    return first.hit ? first : first_in(span.second_half());
  }

 private:
  static double upper_end(const ContactTime& time) {
    return time.upper <= 1.0 ? 1.0 : std::numeric_limits<double>::infinity();
  }

  bool turns() const { return path_ != nullptr && path_->turns(); }

  Vector3d at(int end, double time) const { return before_[end] + time * ways_[end]; }

  Eigen::Isometry3d to_shape(double time) const {
    return path_ == nullptr ? shape_.to_shape
                            : (path_->pose(time) * shape_.in_object).inverse(Eigen::Isometry);
  }

  AxisMotion motion_in(const TimeSpan& span) const {
    const Eigen::Isometry3d first = to_shape(span.begin);
    const Eigen::Isometry3d last = to_shape(span.end());
    return {{first * at(0, span.begin), first * at(1, span.begin)},
            {last * at(0, span.end()), last * at(1, span.end())}};
  }

  /// [m] How far the ends may be from straight ways in the frame of a shape that turns. There a
  /// point at distance r from the object's origin, which passes it with a speed v, is accelerated
  /// by at most ω²r + 2ωv, and the height of an arc is at most an eighth of that.
  double deviation_in(const TimeSpan& span) const {
    if (!turns()) {
      return 0.0;
    }
    const double angle = path_->angle() * span.size;
    double deviation = 0.0;
    for (int i = 0; i < 2; ++i) {
      const double speed = span.size * norm_of(ways_[i] - path_->way());
      const double far = std::max(from_origin(i, span.begin), from_origin(i, span.end()));
      deviation = std::max(
          deviation, angle * (angle * far + 2.0 * speed) / 8.0 + path_->rotation_error() * far);
    }
    return deviation * (1.0 + 0x1p-40);
  }

  double from_origin(int end, double time) const {
    return norm_of(at(end, time) - path_->pose(time).translation());
  }

  const WorldShape& shape_;
  const ObjectPath* const path_;
  const Vector3d before_[2];  // [m]
  const Vector3d ways_[2];    // [m]
  const double distance_;     // [m]
  const double tolerance_;    // [m]
  double error_ = 0.0;        // [m]
};

}  // namespace

ContactTime contact_time(const SegmentAndShape& pair, double distance, double tolerance) {
  return ShapeMotion(pair, distance, tolerance).first_in({0.0, 1.0});
}

}  // namespace fiber
