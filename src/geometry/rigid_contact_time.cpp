#include "src/geometry/rigid_contact_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "src/geometry/norm.hpp"

namespace fiber {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

/// [1] By how much a rotation's length may differ from 1, as messages have them.
constexpr double most_rotation_error = 1e-3;

Quaterniond unit_rotation(const Quaterniond& rotation, const char* which) {
  const double length = rotation.norm();
  if (!(std::abs(length - 1.0) <= most_rotation_error)) {
    throw std::invalid_argument(std::string("the rotation of the ") + which +
                                " segment has a length of " + std::to_string(length) +
                                ", it must be a unit quaternion");
  }
  return Quaterniond(rotation.coeffs() / length);
}

/// A body's segment at the ends of a piece of the motion.
class TurningSegment {
 public:
  TurningSegment(const RigidSegment& segment, const char* which)
      : ends_{segment.ends[0], segment.ends[1]},
        before_{unit_rotation(segment.before.rotation, which), segment.before.position},
        after_{unit_rotation(segment.after.rotation, which), segment.after.position} {
    if (before_.rotation.dot(after_.rotation) < 0.0) {
      after_.rotation.coeffs() *= -1.0;  // the shorter way round
    }
    place(before_, before_points_);
    place(after_, after_points_);
  }

  const Vector3d* before() const { return before_points_; }
  const Vector3d* after() const { return after_points_; }

  /// [m] How far points may be from where straight motion has them.
  double deviation() const {
    const double reach = std::max(norm_of(ends_[0]), norm_of(ends_[1]));
    // Of half the angle: |q₁ − q₀| = 2 sin(θ/4), and asin x is at most x·π/2.
    const double chord = (after_.rotation.coeffs() - before_.rotation.coeffs()).norm();
    const double bound = chord > 0.25 ? 1.5708 : 1.003;
    const double angle = 2.0 * bound * chord;
    const double largest =
        std::max(before_.position.cwiseAbs().maxCoeff(), after_.position.cwiseAbs().maxCoeff());
    // Rotated points and times are off by less than 128 roundings of these.
    return (1.0 + 0x1p-40) * reach * angle * angle / 8.0 + 0x1p-46 * (reach + largest);
  }

  /// Of the motion: the first half, or the second.
  TurningSegment half(bool second) const {
    TurningSegment half = *this;
    (second ? half.before_ : half.after_) = middle();
    half.place(half.before_, half.before_points_);
    half.place(half.after_, half.after_points_);
    return half;
  }

 private:
  Pose middle() const {
    Pose pose;
    pose.rotation.coeffs() = (before_.rotation.coeffs() + after_.rotation.coeffs()).normalized();
    pose.position = 0.5 * before_.position + 0.5 * after_.position;
    return pose;
  }
  void place(const Pose& pose, Vector3d* points) const {
    points[0] = pose.position + pose.rotation._transformVector(ends_[0]);
    points[1] = pose.position + pose.rotation._transformVector(ends_[1]);
  }

  Vector3d ends_[2];
  Pose before_;
  Pose after_;
  Vector3d before_points_[2];
  Vector3d after_points_[2];
};

/// A piece of the motion: `size` of it from `begin`, both exact.
struct MotionPiece {
  TurningSegment a;
  TurningSegment b;
  double begin;
  double size;

  MotionPiece half(bool second) const {
    return {a.half(second), b.half(second), second ? begin + 0.5 * size : begin, 0.5 * size};
  }
};

constexpr double least_piece = 0x1p-40;

ContactTime contact_in(const MotionPiece& piece, const ContactLimit& limit, double tolerance) {
  const double deviation = piece.a.deviation() + piece.b.deviation();
  ContactLimit wider = limit;
  wider.margin += deviation * (1.0 + 0x1p-40);
  const SegmentMotions motions{piece.a.before(), piece.a.after(), piece.b.before(), piece.b.after(),
                               wider};
  const double rest = tolerance - 2.0 * deviation * (1.0 + 0x1p-40);
  ContactTime time = contact_time(motions, std::max(rest, 0.25 * tolerance));
  if (!time.hit) {
    return time;
  }
  if (deviation > 0.25 * tolerance) {
    if (piece.size > least_piece) {
      const ContactTime first = contact_in(piece.half(false), limit, tolerance);
      return first.hit ? first : contact_in(piece.half(true), limit, tolerance);
    }
    return {true, piece.begin, std::numeric_limits<double>::infinity(), false};
  }
  // Only what is nearer than the limit by as much is in contact for certain.
  time.certain = false;
  if (limit.sum() >= 2.0 * deviation) {
    ContactLimit narrower = limit;
    narrower.margin -= deviation * (1.0 + 0x1p-40);
    const SegmentMotions nearer{piece.a.before(), piece.a.after(), piece.b.before(),
                                piece.b.after(), narrower};
    const ContactTime inside = contact_time(nearer, 0.25 * tolerance);
    if (inside.certain && inside.hit) {
      time.upper = inside.upper;
      time.certain = true;
    }
  }
  time.lower = std::max(0.0, piece.begin + piece.size * time.lower - 0x1p-53);
  time.upper = piece.begin + piece.size * time.upper;
  return time;
}

}  // namespace

ContactTime contact_time(const RigidSegment& a, const RigidSegment& b, const ContactLimit& limit,
                         double tolerance) {
  if (!(tolerance > 0.0 && std::isfinite(tolerance))) {
    throw std::invalid_argument("the tolerance of contact times of bodies that turn is " +
                                std::to_string(tolerance) + " m, it must be positive and finite");
  }
  return contact_in({TurningSegment(a, "first"), TurningSegment(b, "second"), 0.0, 1.0}, limit,
                    tolerance);
}

}  // namespace fiber
