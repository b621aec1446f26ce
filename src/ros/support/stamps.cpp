#include "src/ros/support/stamps.hpp"

#include <cstdint>
#include <sstream>
#include <stdexcept>

namespace fiber_proximity_ros {

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
