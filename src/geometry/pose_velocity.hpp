#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// How fast a body moves.
struct BodyTwist {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();   ///< [m/s] of its origin
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();  ///< [rad/s] about its origin, in the world
};

/// Velocity of a body from its last few poses: the slopes of the lines of least squares through its
/// origin, by coordinate, and through its turns, which are summed from pose to pose, each the
/// shorter way round.
class FIBER_PROXIMITY_EXPORT PoseVelocity {
 public:
  /// @param max_frames that count: the newest; at least 2
  explicit PoseVelocity(std::size_t max_frames) : max_frames_(max_frames) {}

  /// Takes a pose, which must be a rotation and a translation. One at a time [s] that is not after
  /// that of the pose before is the first one of new frames.
  void add(double time, const Eigen::Isometry3d& pose);

  std::size_t frame_count() const { return frames_.size(); }

  /// [s] between the first and the last of the frames.
  double duration() const {
    return frames_.empty() ? 0.0 : frames_.back().time - frames_.front().time;
  }

  /// [s] of the newest frame, of which there must be one.
  double time() const { return frames_.back().time; }

  /// Zero of fewer than two frames.
  BodyTwist find() const;

 private:
  struct Frame {
    double time;               // [s]
    Eigen::Vector3d position;  // [m]
    Eigen::Vector3d turn;      // [rad] from the frame before, in the world
  };

  std::size_t max_frames_;
  std::vector<Frame> frames_;
  Eigen::Quaterniond rotation_;  // of the newest frame
};

}  // namespace fiber
