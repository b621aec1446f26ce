#include "validation/geometry/motion_separation.hpp"

#include <algorithm>

namespace fiber {
namespace {

/// A point before and after.
struct Path {
  Eigen::Vector3d before;
  Eigen::Vector3d after;
};

/// Between points that move linearly.
TimePolynomialVector difference(const Path& to, const Path& from) {
  const auto along = [&](int axis) {
    const QuadNumber before = QuadNumber(to.before[axis]) - QuadNumber(from.before[axis]);
    const QuadNumber after = QuadNumber(to.after[axis]) - QuadNumber(from.after[axis]);
    return TimePolynomial({before, after - before}, 2 * (abs(before) + abs(after)));
  };
  return {along(0), along(1), along(2)};
}

}  // namespace

MotionSeparation::MotionSeparation(const HardMotion& motion) {
  const Path a[2] = {{motion.a_before[0], motion.a_after[0]},
                     {motion.a_before[1], motion.a_after[1]}};
  const Path b[2] = {{motion.b_before[0], motion.b_after[0]},
                     {motion.b_before[1], motion.b_after[1]}};
  const TimePolynomialVector u = difference(a[1], a[0]);
  const TimePolynomialVector v = difference(b[1], b[0]);
  const QuadNumber limit = QuadNumber(motion.radius_a) + QuadNumber(motion.radius_b);
  const TimePolynomial squared_limit(limit * limit);
  for (const Path& end : a) {
    add_end(difference(end, b[0]), v, squared_limit);
  }
  for (const Path& end : b) {
    add_end(difference(end, a[0]), u, squared_limit);
  }
  add_lines(u, v, difference(a[0], b[0]), squared_limit);
}

/// An end from the other segment: its line is far away, or a point that the end's foot is beyond.
/// @param offset of the end from the segment's start
/// @param along  from there to its end
void MotionSeparation::add_end(const TimePolynomialVector& offset,
                               const TimePolynomialVector& along,
                               const TimePolynomial& squared_limit) {
  const TimePolynomialVector across = cross(offset, along);
  const TimePolynomialVector from_end = offset - along;
  const TimePolynomial forward = dot(offset, along);
  const TimePolynomial length = dot(along, along);
  kinds_.push_back({{dot(across, across) - squared_limit * length},
                    {-forward, dot(offset, offset) - squared_limit},
                    {forward - length, dot(from_end, from_end) - squared_limit}});
}

/// The lines are far from each other, or their nearest points are beyond an end.
void MotionSeparation::add_lines(const TimePolynomialVector& u, const TimePolynomialVector& v,
                                 const TimePolynomialVector& w,
                                 const TimePolynomial& squared_limit) {
  const TimePolynomialVector normal = cross(u, v);
  const TimePolynomial volume = dot(w, normal);
  const TimePolynomial squared = dot(normal, normal);
  const TimePolynomial s = dot(cross(v, w), normal);
  const TimePolynomial t = dot(cross(u, w), normal);
  kinds_.push_back(
      {{volume * volume - squared_limit * squared}, {-s}, {s - squared}, {-t}, {t - squared}});
}

bool MotionSeparation::holds_between(long double begin, long double end) const {
  const QuadNumber from = begin;
  const QuadNumber to = end;
  return std::all_of(kinds_.begin(), kinds_.end(), [&](const std::vector<Case>& kind) {
    return std::any_of(kind.begin(), kind.end(), [&](const Case& each) {
      return std::all_of(each.begin(), each.end(), [&](const TimePolynomial& polynomial) {
        return polynomial.is_positive(from, to);
      });
    });
  });
}

}  // namespace fiber
