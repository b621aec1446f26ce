#pragma once

#include <ros/time.h>

#include <cstdint>
#include <string>

namespace fiber_proximity_ros {

/// Counts the messages of one source that were refused, and logs them without a flood: a source
/// that sends nonsense does so at camera rate.
class RefusalLog {
 public:
  /// @param source what the log calls it
  explicit RefusalLog(std::string source) : source_(std::move(source)) {}

  void refuse(const std::string& reason);

  std::uint64_t count() const { return count_; }
  const std::string& last_error() const { return last_error_; }

 private:
  std::string source_;
  std::string last_error_;
  ros::SteadyTime last_log_;
  std::uint64_t unlogged_ = 0;
  std::uint64_t count_ = 0;
};

}  // namespace fiber_proximity_ros
