#include "fiber_proximity/ros/waiting_changes.hpp"

#include <stdexcept>
#include <utility>

#include "fiber_proximity/ros/fixed_frame.hpp"

namespace fiber_proximity_ros {

WaitingChanges::WaitingChanges(std::string topic, std::string type, double timeout)
    : topic_(std::move(topic)),
      type_(std::move(type)),
      timeout_(timeout),
      refusals_("'" + topic_ + "' (" + type_ + ")") {}

void WaitingChanges::receive(std::function<void()> apply) {
  ++received_;
  waiting_.push_back({std::move(apply), ros::SteadyTime::now()});
}

void WaitingChanges::refuse(const std::string& reason) {
  ++received_;
  refusals_.refuse(reason);
}

bool WaitingChanges::update() {
  const std::uint64_t applied = applied_;
  while (!waiting_.empty() && apply(waiting_.front())) {
    waiting_.pop_front();
  }
  return applied_ != applied;
}

fiber_proximity::InputStatistics WaitingChanges::statistics(const ros::Time& now) const {
  fiber_proximity::InputStatistics statistics;
  statistics.topic = topic_;
  statistics.type = type_;
  statistics.received = received_;
  statistics.refused = refusals_.count();
  statistics.age = applied_ > 0 ? (now - last_applied_).toSec() : -1.0;
  statistics.last_error = refusals_.last_error();
  return statistics;
}

bool WaitingChanges::apply(const Change& change) {
  try {
    change.apply();
    ++applied_;
    last_applied_ = ros::Time::now();
  } catch (const TransformUnavailable& error) {
    if ((ros::SteadyTime::now() - change.arrival).toSec() <= timeout_) {
      return false;
    }
    refusals_.refuse(error.what());
  } catch (const std::invalid_argument& error) {
    refusals_.refuse(error.what());
  }
  return true;
}

}  // namespace fiber_proximity_ros
