#include "src/ros/inputs/segment_welder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fiber_proximity_ros {
namespace {

bool is_known(const Eigen::Vector3d& point) { return point.allFinite(); }

/// Infinite where one of the points is missing.
double distance(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return is_known(a) && is_known(b) ? (a - b).norm() : std::numeric_limits<double>::infinity();
}

double nearer_end(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& to) {
  return std::min(distance(point, from), distance(point, to));
}

}  // namespace

bool SegmentWelder::add(Eigen::Vector3d from, Eigen::Vector3d to) {
  const double length = is_known(from) && is_known(to) ? (to - from).norm()
                                                       : std::numeric_limits<double>::quiet_NaN();
  const double tolerance = std::fmax(0.0, tolerance_ * std::fmin(length, last_length_));
  if (chain_size() > 0) {
    turn_first_segment_towards(from, to, tolerance);
    Eigen::Vector3d& end = chains_.points.back();
    if (distance(to, end) < distance(from, end) &&
        (is_known(from) || distance(to, end) <= tolerance)) {
      std::swap(from, to);
    }
    if (is_known(end) && is_known(from)) {
      if (distance(from, end) <= tolerance) {
        end = 0.5 * (end + from);
        push(to, length);
        return false;
      }
    } else if (reaches(from, to, length)) {
      if (is_known(from) || (is_known(end) && is_known(to))) {
        push(from, length);  // else it is the same missing point as the end, or as `to`
      }
      push(to, length);
      return false;
    }
    end_chain();
  }
  longest_ = 0.0;
  push(from, length);
  push(to, length);
  return true;
}

void SegmentWelder::end_chain() {
  if (chain_size() > 0) {
    chains_.end_chain();
  }
}

void SegmentWelder::push(const Eigen::Vector3d& point, double length) {
  chains_.points.push_back(point);
  last_length_ = length;
  longest_ = std::fmax(longest_, length);
}

/// True if the chain may go on across missing points: if what is known on both sides is no farther
/// apart than the segments between them would reach, or nothing is known.
bool SegmentWelder::reaches(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                            double length) const {
  const auto known =
      std::find_if(chains_.points.rbegin(),
                   chains_.points.rbegin() + static_cast<std::ptrdiff_t>(chain_size()), is_known);
  const auto missing = static_cast<double>(known - chains_.points.rbegin());
  const double longest = std::fmax(longest_, length);
  const bool is_compared = static_cast<std::size_t>(missing) < chain_size() &&
                           (is_known(from) || is_known(to)) && longest > 0.0;
  const double segments = missing + (is_known(from) ? 1.0 : 2.0) + tolerance_;
  return !is_compared || distance(*known, is_known(from) ? from : to) <= segments * longest;
}

void SegmentWelder::turn_first_segment_towards(const Eigen::Vector3d& from,
                                               const Eigen::Vector3d& to, double tolerance) {
  if (chain_size() != 2) {
    return;  // later ones have an end that is joined already
  }
  Eigen::Vector3d& head = *(chains_.points.end() - 2);
  Eigen::Vector3d& tail = chains_.points.back();
  const double gap = nearer_end(head, from, to);
  if (gap < nearer_end(tail, from, to) && (is_known(tail) || gap <= tolerance)) {
    head.swap(tail);
  }
}

}  // namespace fiber_proximity_ros
