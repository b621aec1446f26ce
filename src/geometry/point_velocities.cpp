#include "src/geometry/point_velocities.hpp"

#include <numeric>
#include <utility>

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
  // Relative to the first frame, as times and places may be large.
  const double first = frames_.front().time;
  const double mean =
      std::accumulate(frames_.begin(), frames_.end(), 0.0,
                      [&](double sum, const Frame& frame) { return sum + (frame.time - first); }) /
      static_cast<double>(frames_.size());
  double squares = 0.0;
  for (const Frame& frame : frames_) {
    const double apart = frame.time - first - mean;
    squares += apart * apart;
  }
  for (const Frame& frame : frames_) {
    const double weight = (frame.time - first - mean) / squares;
    for (std::size_t i = 0; i < count; ++i) {
      velocities[i] += weight * (frame.points[i] - frames_.front().points[i]);
    }
  }
}

}  // namespace fiber
