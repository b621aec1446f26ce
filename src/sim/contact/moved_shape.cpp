#include "src/sim/contact/moved_shape.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/environment/shape_contact_time.hpp"

namespace fiber {

using Eigen::Isometry3d;
using Eigen::Vector3d;

namespace {

/// How a shape looks the same when it is turned.
enum class Symmetry { NONE, ABOUT_Z, ABOUT_ALL };

Symmetry symmetry_of(const Shape& shape) {
  if (std::holds_alternative<SphereShape>(shape)) {
    return Symmetry::ABOUT_ALL;
  }
  const bool is_round = std::holds_alternative<CylinderShape>(shape) ||
                        std::holds_alternative<ConeShape>(shape) ||
                        std::holds_alternative<CapsuleShape>(shape);
  return is_round ? Symmetry::ABOUT_Z : Symmetry::NONE;
}

/// Among the poses in which a shape fills the same space as in the last one, the one that it
/// reaches from the first one with the least turn.
Isometry3d nearest_alike(const Shape& shape, const Isometry3d& first, const Isometry3d& last) {
  constexpr double nothing = 1e-14;  // of a turn: roundings
  const Symmetry symmetry = symmetry_of(shape);
  if (symmetry == Symmetry::NONE) {
    return last;
  }
  Isometry3d alike = last;
  alike.linear() = first.linear();
  if (symmetry == Symmetry::ABOUT_Z) {
    const Eigen::Quaterniond turn(Eigen::Matrix3d(first.linear().transpose() * last.linear()));
    Eigen::Quaterniond about_axis(turn.w(), 0.0, 0.0, turn.z());
    if (about_axis.norm() > nothing) {
      about_axis.normalize();
      const Eigen::Quaterniond swing = turn * about_axis.conjugate();
      if (swing.vec().norm() > nothing) {
        alike.linear() = first.linear() * swing.normalized().toRotationMatrix();
      }
    } else {
      alike.linear() = last.linear();
    }
  }
  return alike;
}

std::array<Vector3d, 2> ends_of(std::uint32_t edge, const std::vector<Vector3d>& values) {
  return {values[edge], values[edge + 1]};
}

double longest_of(const std::array<Vector3d, 2>& ways) {
  return std::sqrt(std::max(ways[0].squaredNorm(), ways[1].squaredNorm()));
}

constexpr int max_halvings = 40;

}  // namespace

MovedShape::MovedShape(const ObstacleShape& source)
    : now_(source), first_(source.pose), last_(source.pose), path_(first_, last_) {
  assign(source);
}

void MovedShape::assign(const ObstacleShape& source) {
  const MovingShape& moving = *source.moving;
  now_ = source;
  first_ = moving.motion->start * moving.in_object;
  last_ = nearest_alike(*source.shape, first_, moving.motion->end * moving.in_object);
  path_ = ObjectPath(first_, last_);
  turn_.setZero();
  if (path_.turns()) {
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(last_.linear() * first_.linear().transpose()));
    turn_ = turn.angle() * turn.axis();
  }
  waits_ = false;
  go_to(path_.moves() ? 0.0 : 1.0);
}

void MovedShape::go_to(double progress) {
  progress_ = progress;
  now_.pose = progress == 0.0 ? first_ : progress == 1.0 ? last_ : path_.pose(progress);
  now_.to_shape = now_.pose.inverse(Eigen::Isometry);
}

Vector3d MovedShape::way(const Vector3d& point) const {
  return path_.way() + turn_.cross(point - now_.pose.translation());
}

Vector3d MovedShape::displacement(const Vector3d& point) const {
  return displacement_since(motion().begin, point);
}

Vector3d MovedShape::displacement_in_solve(const Vector3d& point) const {
  return displacement_since(motion().start, point);
}

Vector3d MovedShape::turned(const Vector3d& vector) const {
  return motion().end.linear() * (motion().begin.linear().transpose() * vector);
}

Vector3d MovedShape::displacement_since(const Isometry3d& pose, const Vector3d& point) const {
  const Isometry3d& here = has_arrived() ? motion().end : motion().start;
  const Vector3d in_object = here.inverse(Eigen::Isometry) * point;
  return motion().end * in_object - pose * in_object;
}

MovedShape::RelativeMotion MovedShape::relative_motion(const std::array<Vector3d, 2>& ends,
                                                       const std::array<Vector3d, 2>& displacements,
                                                       double share) const {
  RelativeMotion motion;
  if (stands_still()) {
    motion.ways = {share * displacements[0], share * displacements[1]};
    return motion;
  }
  // In the frame of a shape that turns, a point at distance r from its origin that passes it with a
  // speed v is accelerated by at most ω²r + 2ωv, and the height of an arc is at most an eighth of
  // that.
  const double part = share * (1.0 - progress_);
  const double angle = part * path_.angle();
  const Isometry3d later = path_.pose(progress_ + part);
  const Isometry3d back = now_.pose * later.inverse(Eigen::Isometry);
  for (std::size_t i = 0; i < 2; ++i) {
    const Vector3d after = ends[i] + share * displacements[i];
    motion.ways[i] = back * after - ends[i];
    if (path_.turns()) {
      const double far = std::max((ends[i] - now_.pose.translation()).norm(),
                                  (after - later.translation()).norm());
      const double speed = (share * displacements[i] - part * path_.way()).norm();
      motion.deviation = std::max(motion.deviation, angle * (angle * far + 2.0 * speed) / 8.0 +
                                                        path_.rotation_error() * far);
    }
  }
  return motion;
}

double bounded_share(const ObstacleContact& contact, const ObstacleDistance& distance,
                     const MovedShape& shape, const std::vector<Vector3d>& positions,
                     const std::vector<Vector3d>& displacements, double part, double share) {
  const double max_loss = part * (distance.nearest.distance - contact.barrier.min_distance());
  const double s = contact.part.on_edge(distance.s);
  const auto ends_of_contact = [&](const std::vector<Vector3d>& values) {
    return contact.point ? std::array<Vector3d, 2>{point_at(values, contact.edge, s),
                                                   point_at(values, contact.edge, s)}
                         : contact.ends(values);
  };
  const std::array<Vector3d, 2> ends = ends_of_contact(positions);
  const std::array<Vector3d, 2> whole = ends_of_contact(displacements);
  for (int i = 0; i < max_halvings && share > 0.0; ++i) {
    const MovedShape::RelativeMotion motion = shape.relative_motion(ends, whole, share);
    if (!contact.point) {
      const double floor = distance.nearest.distance - max_loss + motion.deviation;
      if (longest_of(motion.ways) + motion.deviation <= max_loss ||
          stays_above(floor, distance, ends[1] - ends[0], motion.ways)) {
        return share;
      }
      share *= 0.5;
      continue;
    }
    const double loss = motion.deviation - distance.nearest.gradient.dot(motion.ways[0]);
    if (loss <= max_loss) {
      return share;
    }
    // The way is nearly a multiple of the share.
    constexpr double nearly = 0.99;
    share *= std::max(0.0, nearly * max_loss / loss);
  }
  return 0.0;
}

double bounded_share(std::uint32_t edge, const MovedShape& shape,
                     const std::vector<Vector3d>& positions,
                     const std::vector<Vector3d>& displacements, double part, double share) {
  constexpr double tolerance = 0.1;       // of the distance that is left, for the time of contact
  constexpr double max_deviation = 0.05;  // of the distance
  const std::array<Vector3d, 2> ends = ends_of(edge, positions);
  const std::array<Vector3d, 2> whole = ends_of(edge, displacements);
  const ObstacleShape& now = shape.now();
  MovedShape::RelativeMotion motion = shape.relative_motion(ends, whole, share);
  const double farthest = longest_of(motion.ways) + motion.deviation;
  const AxisDistance nearest =
      axis_distance(*now.shape, now.to_shape * ends[0], now.to_shape * ends[1], farthest / part);
  if (farthest <= part * nearest.lower) {
    return share;
  }
  const double gap = std::max(0.0, nearest.lower);
  for (int i = 0; i < max_halvings && motion.deviation > max_deviation * gap; ++i) {
    share *= 0.5;
    motion = shape.relative_motion(ends, whole, share);
  }
  if (motion.deviation > max_deviation * gap) {
    return 0.0;
  }
  AxisMotion axis;
  for (std::size_t i = 0; i < 2; ++i) {
    axis.before[i] = now.to_shape * ends[i];
    axis.after[i] = now.to_shape * (ends[i] + motion.ways[i]);
  }
  const double left = (1.0 - part) * gap;
  const double error = 0x1p-48 * (reach(*now.shape) + now.pose.translation().norm() +
                                  ends[0].norm() + ends[1].norm());
  const ContactTime time =
      contact_time(*now.shape, axis, {left, error + motion.deviation}, tolerance * left);
  return time.hit ? share * time.lower : share;
}

}  // namespace fiber
