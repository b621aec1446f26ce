#pragma once

#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace fiber_proximity_ros {

/// Counts the messages of one source that were refused, and logs them without a flood: a source
/// that sends nonsense does so at camera rate. Each reason is logged at most once a second, so that
/// a frequent one does not hide another; reasons that differ in numbers alone are one. Beyond
/// a few reasons within a second, others are only counted.
class RefusalLog {
 public:
  /// Most reasons that are logged within a second.
  static constexpr std::size_t most_reasons = 10;

  /// @param source what the log calls it
  explicit RefusalLog(std::string source) : source_(std::move(source)) {}

  void refuse(const std::string& reason);

  std::uint64_t count() const { return count_; }
  const std::string& last_error() const { return last_error_; }

 private:
  struct Reason {
    std::string kind;            ///< the reason without its numbers
    ros::SteadyTime logged;      ///< when it was last; zero: not yet
    std::uint64_t unlogged = 0;  ///< times since
  };

  Reason* place_of(const std::string& kind, const ros::SteadyTime& now);

  std::string source_;
  std::string last_error_;
  std::vector<Reason> reasons_;
  std::uint64_t unlogged_ = 0;  // times for reasons that are not among these
  std::uint64_t count_ = 0;
};

}  // namespace fiber_proximity_ros
