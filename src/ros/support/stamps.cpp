#include "src/ros/support/stamps.hpp"

#include <algorithm>
#include <cstdint>
#include <sstream>
#include <stdexcept>

namespace fiber_proximity_ros {

std::chrono::nanoseconds to_time(const ros::Time& stamp) {
  return std::chrono::nanoseconds(static_cast<std::int64_t>(stamp.toNSec()));
}

ros::Time to_stamp(std::chrono::nanoseconds time) {
  // As ros::Time::fromNSec(), whose checks take most of its time; each contact has several stamps.
  constexpr std::int64_t second = 1'000'000'000;
  constexpr std::int64_t end = second << 32;
  const std::int64_t count = std::clamp<std::int64_t>(time.count(), 0, end - 1);
  ros::Time stamp;
  stamp.sec = static_cast<std::uint32_t>(count / second);
  stamp.nsec = static_cast<std::uint32_t>(count % second);
  return stamp;
}

void validate_stamp(const ros::Time& stamp, const ros::Time& now, double max_ahead) {
  std::ostringstream error;
  if (constexpr std::uint32_t second = 1'000'000'000; stamp.nsec >= second) {
    error << "its stamp has " << stamp.nsec << " nanoseconds, it must have fewer than " << second;
    throw std::invalid_argument(error.str());
  }
  const double ahead = stamp.toSec() - now.toSec();
  if (ros::Time::isValid() && ahead > max_ahead) {
    error << "its stamp " << stamp << " is " << ahead << " s ahead of the node's time " << now
          << ", it may be " << max_ahead << " s ahead (max_stamp_ahead)";
    throw std::invalid_argument(error.str());
  }
}

}  // namespace fiber_proximity_ros
