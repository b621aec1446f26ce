#pragma once

#include <algorithm>
#include <chrono>

namespace fiber {

/// When to answer. May be asked from several threads at once.
class Deadline {
 public:
  /// @param seconds from now; 0 for none
  explicit Deadline(double seconds)
      : seconds_(seconds), start_(seconds > 0.0 ? Clock::now() : Clock::time_point()) {}

  bool is_set() const { return seconds_ > 0.0; }

  /// Whether this part of the time has passed, but for what is needed yet [s]. Without a deadline
  /// it costs nothing.
  bool has_passed(double part = 1.0, double needed = 0.0) const {
    return is_set() && elapsed() >= part * seconds_ - needed;
  }

  /// [s] For a deadline of what comes next: at least a nanosecond, 0 if there is none.
  double left() const {
    constexpr double shortest = 1e-9;
    return is_set() ? std::max(seconds_ - elapsed(), shortest) : 0.0;
  }

 private:
  using Clock = std::chrono::steady_clock;

  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

  double seconds_;
  Clock::time_point start_;
};

}  // namespace fiber
