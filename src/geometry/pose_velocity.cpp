#include "src/geometry/pose_velocity.hpp"

#include <cmath>

#include "src/geometry/time_line.hpp"

namespace fiber {
namespace {

/// [rad] From one rotation to another, the shorter way round, along its axis.
Eigen::Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  if (from.coeffs() == to.coeffs()) {
    return Eigen::Vector3d::Zero();
  }
  const Eigen::Quaterniond turn = to * from.conjugate();
  const double sine = turn.vec().norm();  // of half the angle
  const double angle = 2.0 * std::atan2(sine, std::abs(turn.w()));
  const double sign = turn.w() < 0.0 ? -1.0 : 1.0;
  return (sine > 0.0 ? sign * angle / sine : 0.0) * turn.vec();
}

}  // namespace

void PoseVelocity::add(double time, const Eigen::Isometry3d& pose) {
  if (!frames_.empty() && time <= frames_.back().time) {
    frames_.clear();
  }
  if (frames_.size() >= max_frames_) {
    frames_.erase(frames_.begin());
  }
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(pose.linear()).normalized();
  Frame frame{time, pose.translation(), Eigen::Vector3d::Zero()};
  if (!frames_.empty()) {
    frame.turn = turn_between(rotation_, rotation);
  }
  frames_.push_back(frame);
  rotation_ = rotation;
}

BodyTwist PoseVelocity::find() const {
  BodyTwist twist;
  if (frames_.size() < 2) {
    return twist;
  }
  const TimeLine line(frames_);
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  for (auto frame = frames_.begin() + 1; frame != frames_.end(); ++frame) {
    const double weight = line.weight(frame->time);
    turned += frame->turn;
    twist.linear += weight * (frame->position - frames_.front().position);
    twist.angular += weight * turned;
  }
  return twist;
}

}  // namespace fiber
