#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "src/geometry/exact_numbers.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;

/// Nearest points by their parameters s / denominator and t / denominator.
struct Nearest {
  Integer s;
  Integer t;
  Integer denominator = 1;
  IntegerVector delta;  // from p's point to q's, times the denominator
  Integer squared;      // |delta|²

  bool is_closer_than(const Nearest& other) const {
    return squared * other.denominator * other.denominator <
           other.squared * denominator * denominator;
  }
};

/// Two segments, exactly, in units of 2^exponent.
struct IntegerPair {
  int exponent;
  IntegerVector u;  // p1 − p0
  IntegerVector v;  // q1 − q0
  IntegerVector w;  // p0 − q0

  Nearest at(const Integer& s, const Integer& t, const Integer& denominator) const {
    Nearest nearest{s, t, denominator, t * v - s * u - denominator * w, 0};
    nearest.squared = dot(nearest.delta, nearest.delta);
    return nearest;
  }
};

/// @param finest at most this exponent, for other numbers in the same units
IntegerPair integer_pair(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                         const Vector3d& q1, int finest) {
  int exponent = std::min(last_bit({p0, p1, q0, q1}), finest);
  exponent = exponent == std::numeric_limits<int>::max() ? 0 : exponent;  // all are 0
  const IntegerVector a = scaled_integers(p0, exponent);
  const IntegerVector b = scaled_integers(q0, exponent);
  return {exponent, scaled_integers(p1, exponent) - a, scaled_integers(q1, exponent) - b, a - b};
}

/// Parameter, as a fraction of the squared length, of the projection of a point at `offset` from a
/// segment's start.
Integer project(const IntegerVector& offset, const IntegerVector& direction,
                const Integer& squared_length) {
  const Integer along = dot(offset, direction);
  return along < 0 ? Integer(0) : std::min(along, squared_length);
}

/// The best of the four end points projected onto the other segment.
Nearest nearest_end(const IntegerPair& pair) {
  const auto& [exponent, u, v, w] = pair;
  const Integer zero = 0;
  // A segment of no length has parameter 0 everywhere.
  const Integer uu = std::max(dot(u, u), Integer(1));
  const Integer vv = std::max(dot(v, v), Integer(1));
  const IntegerVector minus_w = Integer(-1) * w;
  Nearest best = pair.at(zero, project(w, v, vv), vv);
  for (const Nearest& other :
       {pair.at(vv, project(w + u, v, vv), vv), pair.at(project(minus_w, u, uu), zero, uu),
        pair.at(project(minus_w + v, u, uu), uu, uu)}) {
    if (other.is_closer_than(best)) {
      best = other;
    }
  }
  return best;
}

Nearest nearest_points(const IntegerPair& pair) {
  const auto& [exponent, u, v, w] = pair;
  const IntegerVector normal = cross(u, v);
  const Integer denominator = dot(normal, normal);
  const Integer s = dot(cross(v, w), normal);
  const Integer t = dot(cross(u, w), normal);
  // The critical point of a convex function, where it has one inside, is its minimum.
  if (s > 0 && s < denominator && t > 0 && t < denominator) {
    return pair.at(s, t, denominator);
  }
  return nearest_end(pair);
}

}  // namespace

SegmentDistance exact_segment_distance(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                                       const Vector3d& q1) {
  const IntegerPair pair = integer_pair(p0, p1, q0, q1, std::numeric_limits<int>::max());
  const Nearest nearest = nearest_points(pair);
  const Rounded distance = rounded_root(nearest.squared, nearest.denominator, pair.exponent);
  SegmentDistance result;
  result.s = rounded_quotient(nearest.s, nearest.denominator, 0).value;
  result.t = rounded_quotient(nearest.t, nearest.denominator, 0).value;
  for (int axis = 0; axis < 3; ++axis) {
    const Integer& coordinate = nearest.delta[static_cast<std::size_t>(axis)];
    result.delta[axis] = rounded_quotient(coordinate, nearest.denominator, pair.exponent).value;
  }
  result.distance = distance.value;
  if (!distance.exact) {
    const double above = std::nextafter(distance.value, std::numeric_limits<double>::infinity());
    result.error = above - distance.value;
  }
  return result;
}

bool exact_gap_at_most(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                       const Vector3d& q1, const ContactLimit& limit) {
  if (limit.margin == std::numeric_limits<double>::infinity()) {
    return true;
  }
  const auto& [radius_a, radius_b, margin] = limit;
  const IntegerPair pair = integer_pair(
      p0, p1, q0, q1, std::min({last_bit(radius_a), last_bit(radius_b), last_bit(margin)}));
  Integer sum = 0;
  for (const double part : {radius_a, radius_b, margin}) {
    sum += scaled_integer(part, pair.exponent);
  }
  if (sum < 0) {
    return false;
  }
  const Nearest nearest = nearest_points(pair);
  const Integer reach = sum * nearest.denominator;
  return nearest.squared <= reach * reach;
}

}  // namespace fiber
