#include "src/environment/shape_contact_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "src/environment/convex_solids.hpp"
#include "src/environment/triangle_distance.hpp"
#include "src/geometry/norm.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double never = std::numeric_limits<double>::infinity();

/// A part of coordinates: more than all roundings of planes and distances together.
constexpr double rounding_of_planes = 0x1p-45;

/// Lengths of normals of sheets and columns of rotations may be off by a little, which validate()
/// allows; a distance then changes by so much more than its point moves.
constexpr double steepest = 1.0 + 0x1p-18;

template <class Solid>
AxisDistance distance_of_axis(const Solid& solid, const Vector3d& p0, const Vector3d& p1) {
  return axis_distance(solid, p0, p1);
}

AxisDistance distance_of_axis(const TriangleCorners& triangle, const Vector3d& p0,
                              const Vector3d& p1) {
  const SegmentTriangle found = segment_triangle(p0, p1, triangle);
  const Vector3d between = p0 + found.s * (p1 - p0) - found.nearest;
  return {found.s, found.distance, found.distance, unit_of(between)};
}

/// The part of a direction at right angles to where the solid is straight in a plane of this
/// normal: along its own axes, as far as they are in the plane.
template <class Solid>
Vector3d off_straight(const Solid& /*solid*/, const Vector3d& normal, const Vector3d& direction) {
  Vector3d off = direction;
  for (int i = 0; i < 3; ++i) {
    off[i] = normal[i] == 0.0 ? 0.0 : direction[i];
  }
  return off;
}

/// For a triangle this is along the edge that is in the plane, nearly.
Vector3d off_straight(const TriangleCorners& triangle, const Vector3d& normal,
                      const Vector3d& direction) {
  constexpr double nearly = 1e-6;
  for (std::size_t i = 0; i < triangle.size(); ++i) {
    const Vector3d edge = unit_of(triangle[(i + 1) % triangle.size()] - triangle[i]);
    if (std::abs(edge.dot(normal)) < nearly) {
      return direction - edge.dot(direction) * edge;
    }
  }
  return direction;
}

/// An axis at one time of its motion, and how its ends move from there.
struct AxisState {
  AxisState(const AxisMotion& motion, double time) {
    for (int i = 0; i < 2; ++i) {
      displacements[i] = motion.after[i] - motion.before[i];
      ends[i] = motion.before[i] + time * displacements[i];
    }
  }
  Vector3d ends[2];           // [m]
  Vector3d displacements[2];  // [m] in all of the motion
};

/// A plane through the nearest point of a solid: how far both ends of an axis are beyond it.
template <class Solid>
class SeparatingPlane {
 public:
  /// @param apart [m] how far the ends must be beyond it so that there is no contact
  SeparatingPlane(const Solid& solid, const AxisState& axis, const Vector3d& normal, double apart)
      : solid_(solid),
        axis_(axis),
        normal_(normal),
        apart_(apart),
        height_(support(solid, normal)) {}

  /// For how long both ends stay beyond it; 0 if they are not.
  double separates_for() const {
    constexpr double min_length = 0.5;
    if (!(normal_.norm() >= min_length)) {
      return 0.0;
    }
    double time = never;
    for (int i = 0; i < 2; ++i) {
      const double above = normal_.dot(axis_.ends[i]) - height_ - apart_ * length(normal_);
      const double fall = -normal_.dot(axis_.displacements[i]);
      if (!(above > 0.0)) {
        return 0.0;
      }
      time = fall > 0.0 ? std::min(time, above / fall) : time;
    }
    return time;
  }

  /// Bounds a plane that turns with the axis, and moves along as the solid needs it: for the most
  /// of the time, a quarter of it, a sixteenth, … that is proven to be free, if it is more than
  /// `least`.
  double turning_separates_for(double most, double least) const {
    constexpr double less = 0.25;
    const Vector3d turn = turning();
    double time = most;
    while (time > least && !separates_turning(turn, time)) {
      time *= less;
    }
    return time > least ? time : 0.0;
  }

 private:
  static double length(const Vector3d& normal) { return std::max(normal.norm(), 1.0); }

  /// How the normal changes so that it stays at right angles to the axis, and to what of the solid
  /// is straight.
  Vector3d turning() const {
    const Vector3d along = axis_.ends[1] - axis_.ends[0];
    const Vector3d difference = axis_.displacements[1] - axis_.displacements[0];
    const Vector3d free = off_straight(solid_, normal_, along);
    return (-normal_.dot(difference) / free.dot(along)) * free;
  }

  /// The support of the solid is convex: it is at most what is between its values at both times.
  bool separates_turning(const Vector3d& turn, double time) const {
    constexpr double longest_normal = 4.0;
    const Vector3d last = normal_ + time * turn;
    const double needed = apart_ * std::max(length(normal_), length(last));
    const double rise = (support(solid_, last) - height_) / time;
    if (!(last.norm() <= longest_normal) || !std::isfinite(rise)) {
      return false;
    }
    bool separates = true;
    for (int i = 0; i < 2 && separates; ++i) {
      const double start = normal_.dot(axis_.ends[i]) - height_ - needed;
      const double slope = normal_.dot(axis_.displacements[i]) + turn.dot(axis_.ends[i]) - rise;
      const double bend = turn.dot(axis_.displacements[i]);
      const double lowest = bend > 0.0 ? std::clamp(-slope / (2.0 * bend), 0.0, time) : 0.0;
      for (const double at : {0.0, lowest, time}) {
        separates = separates && start + at * (slope + at * bend) > 0.0;
      }
    }
    return separates;
  }

  const Solid& solid_;
  const AxisState& axis_;
  const Vector3d normal_;
  const double apart_;   // [m]
  const double height_;  // [m] of the solid along the normal
};

/// One axis and one convex solid.
template <class Solid>
class SolidAdvance {
 public:
  /// @param error [m] of places and roundings together
  SolidAdvance(const Solid& solid, const AxisMotion& motion, double limit, double error,
               double tolerance)
      : solid_(solid), motion_(motion), limit_(limit), error_(error), tolerance_(tolerance) {
    const AxisState axis(motion, 0.0);
    speed_ = steepest * std::max(norm_of(axis.displacements[0]), norm_of(axis.displacements[1]));
  }

  /// The contact that begins before this time, if there is one.
  /// @param guess a normal that may separate them all the time: where it does, that was all.
  ///              Becomes the normal of a plane that has separated them last
  ContactTime first_before(double until, Vector3d& guess) const {
    constexpr int max_steps = 500;
    const AxisState start(motion_, 0.0);
    if (SeparatingPlane<Solid>(solid_, start, guess, limit_ + error_).separates_for() >= until) {
      return {};
    }
    double time = 0.0;
    for (int step = 0; step < max_steps; ++step) {
      const AxisState axis(motion_, time);
      const AxisDistance near = distance_of_axis(solid_, axis.ends[0], axis.ends[1]);
      const double next = time + free_for(axis, near, until - time, guess);
      if (next >= until) {
        return {};
      }
      if (is_within(near, tolerance_) || next <= time) {
        return found_from(time, near);
      }
      time = next;
    }
    return {true, time, never, false};
  }

 private:
  bool is_within(const AxisDistance& near, double more) const {
    return near.distance + error_ <= limit_ + more;
  }

  /// How long there is certainly no contact from now on, or at least `enough`.
  double free_for(const AxisState& axis, const AxisDistance& near, double enough,
                  Vector3d& guess) const {
    const double apart = limit_ + error_;
    const double gap = near.lower - apart;
    double time = gap > 0.0 ? gap / speed_ : 0.0;
    // Where the axis is nearest between its ends the gradient is at right angles to it, nearly.
    const Vector3d along = unit_of(axis.ends[1] - axis.ends[0]);
    const Vector3d upright = unit_of(near.gradient - near.gradient.dot(along) * along);
    for (const Vector3d& normal : {near.gradient, upright}) {
      const SeparatingPlane<Solid> plane(solid_, axis, normal, apart);
      if (time < enough) {
        time = std::max(time, plane.separates_for());
        guess = time < enough ? guess : normal;
      }
      if (time < enough) {
        time = std::max(time, plane.turning_separates_for(enough, std::max(time, min_turning)));
      }
    }
    return time;
  }

  /// There is none before `lower`, and the axis is within the tolerance, or so near that nothing is
  /// proven any more. Looks for a time at which there is one, further ahead from look to look.
  ContactTime found_from(double lower, AxisDistance near) const {
    ContactTime found{true, lower, never, false};
    double step = std::max({near.distance - limit_, tolerance_, error_}) / speed_;
    double time = lower;
    while (true) {
      if (is_within(near, 0.0)) {
        found.upper = time;
        found.certain = true;
        return found;
      }
      const bool is_near = is_within(near, tolerance_);
      const bool was_near = found.upper < never;
      if (is_near && !was_near) {
        found.upper = time;
      }
      if ((was_near && !is_near) || time >= 1.0) {
        return found;
      }
      time = std::min(time + step, 1.0);
      step *= 2.0;
      const AxisState axis(motion_, time);
      near = distance_of_axis(solid_, axis.ends[0], axis.ends[1]);
    }
  }

  static constexpr double min_turning = 0x1p-20;

  const Solid& solid_;
  const AxisMotion& motion_;
  const double limit_;      // [m]
  const double error_;      // [m]
  const double tolerance_;  // [m]
  double speed_ = 0.0;      // [m] in all of the motion, of the faster end
};

/// The time of several solids is that of the first one, certain if one of them is.
void combine(const ContactTime& time, ContactTime& first) {
  if (!time.hit) {
    return;
  }
  if (!first.hit) {
    first = time;
    return;
  }
  first.lower = std::min(first.lower, time.lower);
  if (time.certain == first.certain) {
    first.upper = std::min(first.upper, time.upper);
  } else if (time.certain) {
    first.upper = time.upper;
    first.certain = true;
  }
}

class MovingAxis {
 public:
  MovingAxis(const AxisMotion& motion, const AxisLimit& limit, double tolerance, double reach)
      : motion_(motion), limit_(limit.distance), tolerance_(tolerance) {
    double largest = reach;
    for (int i = 0; i < 2; ++i) {
      box_.extend(motion.before[i]).extend(motion.after[i]);
      largest = std::max(
          {largest, motion.before[i].cwiseAbs().maxCoeff(), motion.after[i].cwiseAbs().maxCoeff()});
    }
    error_ =
        limit.error + rounding_of_planes * (limit_ + largest) + std::numeric_limits<double>::min();
  }

  template <class Solid>
  ContactTime operator()(const Solid& solid) const {
    return advance(solid, motion_, 1.0);
  }

  ContactTime operator()(const std::shared_ptr<const TriangleMesh>& mesh) const {
    ContactTime first;
    mesh->visit_near(box_, within(), [&](const TriangleCorners& triangle) {
      combine(advance(triangle, motion_, until(first)), first);
    });
    return first;
  }

  ContactTime operator()(const std::shared_ptr<const OccupancyOctree>& octree) const {
    const BoxShape cell{Vector3d::Constant(octree->resolution())};
    ContactTime first;
    octree->visit_near(box_, within(), [&](const Vector3d& centre) {
      AxisMotion motion = motion_;
      for (int i = 0; i < 2; ++i) {
        motion.before[i] -= centre;
        motion.after[i] -= centre;
      }
      combine(advance(cell, motion, until(first)), first);
    });
    return first;
  }

 private:
  template <class Solid>
  ContactTime advance(const Solid& solid, const AxisMotion& motion, double until) const {
    return SolidAdvance<Solid>(solid, motion, limit_, error_, tolerance_)
        .first_before(until, guess_);
  }

  static double until(const ContactTime& first) {
    return first.hit && first.certain ? first.upper : 1.0;
  }
  double within() const { return (limit_ + error_) * (1.0 + 0x1p-40); }  // [m]

  const AxisMotion& motion_;
  const double limit_;      // [m]
  const double tolerance_;  // [m]
  double error_ = 0.0;      // [m]
  WorldBox box_;            // around the difference of the axis [m]
  // A plane that separates the axis from one triangle often does so from the next ones.
  mutable Vector3d guess_ = Vector3d::Zero();
};

}  // namespace

ContactTime contact_time(const Shape& shape, const AxisMotion& motion, const AxisLimit& limit,
                         double tolerance) {
  return std::visit(MovingAxis(motion, limit, tolerance, reach(shape)), shape);
}

}  // namespace fiber
