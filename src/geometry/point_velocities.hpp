#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <deque>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// Velocities of points from their last few frames: for each point the slope of the line through
/// its places over time with the least sum of squared errors.
class FIBER_PROXIMITY_EXPORT PointVelocities {
 public:
  /// @param max_frames that count: the newest; at least 2
  explicit PointVelocities(std::size_t max_frames) : max_frames_(max_frames) {}

  /// Takes a frame. One with another number of points, or a time [s] that is not after that of the
  /// frame before, is the first one of new frames.
  void add(double time, const std::vector<Eigen::Vector3d>& points);

  void forget() { frames_.clear(); }

  std::size_t frame_count() const { return frames_.size(); }

  /// [s] between the first and the last of the frames.
  double duration() const {
    return frames_.empty() ? 0.0 : frames_.back().time - frames_.front().time;
  }

  /// [m/s] by point; of fewer than two frames all are 0.
  void find(std::vector<Eigen::Vector3d>& velocities) const;

 private:
  struct Frame {
    double time;
    std::vector<Eigen::Vector3d> points;
  };

  std::size_t max_frames_;
  std::deque<Frame> frames_;
};

}  // namespace fiber
