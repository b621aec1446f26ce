#include "fiber_proximity/ros/segment_welder.hpp"

#include <algorithm>
#include <utility>

namespace fiber_proximity_ros {
namespace {

double nearer_end(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                  const Eigen::Vector3d& to) {
  return std::min((point - from).norm(), (point - to).norm());
}

}  // namespace

bool SegmentWelder::add(Eigen::Vector3d from, Eigen::Vector3d to) {
  const double length = (to - from).norm();
  if (chain_size() > 0) {
    turn_first_segment_towards(from, to);
    Eigen::Vector3d& end = chains_.points.back();
    if ((to - end).norm() < (from - end).norm()) {
      std::swap(from, to);
    }
    if ((from - end).norm() <= tolerance_ * std::min(length, last_length_)) {
      end = 0.5 * (end + from);
      chains_.points.push_back(to);
      last_length_ = length;
      return false;
    }
    end_chain();
  }
  chains_.points.push_back(from);
  chains_.points.push_back(to);
  last_length_ = length;
  return true;
}

void SegmentWelder::end_chain() {
  if (chain_size() > 0) {
    chains_.end_chain();
  }
}

void SegmentWelder::turn_first_segment_towards(const Eigen::Vector3d& from,
                                               const Eigen::Vector3d& to) {
  if (chain_size() != 2) {
    return;  // later ones have an end that is joined already
  }
  Eigen::Vector3d& head = *(chains_.points.end() - 2);
  Eigen::Vector3d& tail = chains_.points.back();
  if (nearer_end(head, from, to) < nearer_end(tail, from, to)) {
    head.swap(tail);
  }
}

}  // namespace fiber_proximity_ros
