#include "src/ros/inputs/segment_welder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;

/// The part of a segment's length within which ends coincide but for rounding.
constexpr double coincidence = 1e-3;

bool is_known(const Vector3d& point) { return point.allFinite(); }

/// The distance of two points, infinite where one of them is missing.
double distance(const Vector3d& a, const Vector3d& b) {
  return is_known(a) && is_known(b) ? (a - b).norm() : std::numeric_limits<double>::infinity();
}

double nearer_end(const Vector3d& point, const Vector3d& from, const Vector3d& to) {
  return std::min(distance(point, from), distance(point, to));
}

}  // namespace

bool SegmentWelder::add(const Vector3d& from, const Vector3d& to, double tolerance) {
  const double length = is_known(from) && is_known(to) ? (to - from).norm()
                                                       : std::numeric_limits<double>::quiet_NaN();
  if (fiber_size() > 0) {
    const double reach = std::fmax(0.0, tolerance * std::fmin(length, last_length_));  // [m]
    const bool has_turned_first = turn_first_segment_towards(from, to, reach);
    if (join(from, to, length, reach, tolerance)) {
      turned_count_ += has_turned_first ? 1 : 0;
      return false;
    }
    if (has_turned_first) {  // in vain
      (fibers_.points.end() - 2)->swap(fibers_.points.back());
    }
    end_fiber();
  }
  longest_ = 0.0;
  push(from, length);
  push(to, length);
  return true;
}

void SegmentWelder::end_fiber() {
  if (fiber_size() > 0) {
    fibers_.end_chain();
  }
}

/// @returns whether the segment is part of the fibre now
bool SegmentWelder::join(Vector3d from, Vector3d to, double length, double reach,
                         double tolerance) {
  Vector3d& end = fibers_.points.back();
  const bool is_turned =
      distance(to, end) < distance(from, end) && (is_known(from) || distance(to, end) <= reach);
  if (is_turned) {
    std::swap(from, to);
  }
  if (is_known(end) && is_known(from)) {
    const double gap = distance(from, end);
    if (gap > reach) {
      return false;
    }
    if (gap > coincidence * std::fmin(length, last_length_)) {
      largest_gap_ = std::max(largest_gap_, gap);
    }
    end = 0.5 * (end + from);
  } else if (!reaches(from, to, length, tolerance)) {
    return false;
  } else if (is_known(from) || (is_known(end) && is_known(to))) {
    push(from, length);  // else it is the same missing point as the end, or as `to`
  }
  push(to, length);
  turned_count_ += is_turned ? 1 : 0;
  return true;
}

void SegmentWelder::push(const Vector3d& point, double length) {
  fibers_.points.push_back(point);
  last_length_ = length;
  longest_ = std::fmax(longest_, length);
}

/// True if the fibre may go on across missing points: if what is known on both sides is no
/// farther apart than the segments between them would reach, or nothing is known.
bool SegmentWelder::reaches(const Vector3d& from, const Vector3d& to, double length,
                            double tolerance) const {
  const auto known =
      std::find_if(fibers_.points.rbegin(),
                   fibers_.points.rbegin() + static_cast<std::ptrdiff_t>(fiber_size()), is_known);
  const auto missing = static_cast<double>(known - fibers_.points.rbegin());
  const double longest = std::fmax(longest_, length);
  const bool is_compared = static_cast<std::size_t>(missing) < fiber_size() &&
                           (is_known(from) || is_known(to)) && longest > 0.0;
  const double segments = missing + (is_known(from) ? 1.0 : 2.0) + tolerance;
  return !is_compared || distance(*known, is_known(from) ? from : to) <= segments * longest;
}

/// Turns the fibre's first segment if its other end is nearer to the next segment. Later segments
/// cannot be turned: one of their ends is joined already.
/// @returns whether it is turned
bool SegmentWelder::turn_first_segment_towards(const Vector3d& from, const Vector3d& to,
                                               double reach) {
  if (fiber_size() != 2) {
    return false;
  }
  Vector3d& head = *(fibers_.points.end() - 2);
  Vector3d& tail = fibers_.points.back();
  const double gap = nearer_end(head, from, to);
  if (!(gap < nearer_end(tail, from, to) && (is_known(tail) || gap <= reach))) {
    return false;
  }
  head.swap(tail);
  return true;
}

}  // namespace fiber_proximity_ros
