#pragma once

#include <numeric>

namespace fiber {

/// The line of least squares through values over time: its slope is the sum of the values, or of
/// their differences from any one of them, each with the weight of its time.
class TimeLine {
 public:
  /// @param frames two at least, each with a time [s] that is after that of the frame before
  template <class Frames>
  explicit TimeLine(const Frames& frames) : first_(frames.front().time) {
    mean_ = std::accumulate(
                frames.begin(), frames.end(), 0.0,
                [this](double sum, const auto& frame) { return sum + (frame.time - first_); }) /
            static_cast<double>(frames.size());
    for (const auto& frame : frames) {
      const double apart = frame.time - first_ - mean_;
      squares_ += apart * apart;
    }
  }

  /// [1/s]
  double weight(double time) const { return (time - first_ - mean_) / squares_; }

 private:
  double first_;  // [s] what the others are relative to, as times may be large
  double mean_ = 0.0;
  double squares_ = 0.0;
};

}  // namespace fiber
