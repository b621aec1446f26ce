#include "src/geometry/point_velocities.hpp"

#include <utility>

#include "src/geometry/time_line.hpp"

namespace fiber {

void PointVelocities::add(double time, const std::vector<Eigen::Vector3d>& points) {
  if (!frames_.empty() &&
      (time <= frames_.back().time || points.size() != frames_.back().points.size())) {
    frames_.clear();
  }
  Frame frame{};
  if (frames_.size() >= max_frames_) {
    frame = std::move(frames_.front());  // for its memory
    frames_.pop_front();
  }
  frame.time = time;
  frame.points = points;
  frames_.push_back(std::move(frame));
}

void PointVelocities::find(std::vector<Eigen::Vector3d>& velocities) const {
  const std::size_t count = frames_.empty() ? 0 : frames_.front().points.size();
  velocities.assign(count, Eigen::Vector3d::Zero());
  if (frames_.size() < 2) {
    return;
  }
  const TimeLine line(frames_);
  // Relative to the first frame, as places may be far away.
  for (const Frame& frame : frames_) {
    const double weight = line.weight(frame.time);
    for (std::size_t i = 0; i < count; ++i) {
      velocities[i] += weight * (frame.points[i] - frames_.front().points[i]);
    }
  }
}

}  // namespace fiber
