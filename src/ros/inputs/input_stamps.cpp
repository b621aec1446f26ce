#include "src/ros/inputs/input_stamps.hpp"

#include <sstream>
#include <stdexcept>

#include "src/ros/support/stamps.hpp"

namespace fiber_proximity_ros {

void InputStamps::check(const ros::Time& stamp, const ros::Time& now) const {
  validate_stamp(stamp, now, timing_.max_stamp_ahead);
  const bool starts_anew = !last_arrival_ || (now - *last_arrival_).toSec() > timing_.input_timeout;
  if (!starts_anew && stamp < *last_stamp_) {
    std::ostringstream error;
    error << "its stamp " << stamp << " is older than " << *last_stamp_
          << ", that of the message before it";
    throw std::invalid_argument(error.str());
  }
}

bool InputStamps::repeats(const ros::Time& header_stamp, bool is_news) {
  is_repeating_ = !header_stamp.isZero() && header_stamp == placed_header_stamp_ && !is_news;
  return is_repeating_;
}

void InputStamps::receive(const FiberMessage& message) {
  last_stamp_ = message.stamp;
  last_arrival_ = message.arrival;
}

void InputStamps::place(const FiberMessage& message) {
  placed_header_stamp_ = message.header.stamp;
  placed_arrival_ = message.arrival;
}

bool InputStamps::is_silent(const ros::Time& now) const {
  return !placed_arrival_ || (now - *placed_arrival_).toSec() > timing_.input_timeout;
}

}  // namespace fiber_proximity_ros
