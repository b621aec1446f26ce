#include "src/ros/environment/change_topic.hpp"

#include <utility>

namespace fiber_proximity_ros {

ChangeTopic::ChangeTopic(std::string topic, std::string type)
    : topic_(std::move(topic)),
      type_(std::move(type)),
      refusals_("'" + topic_ + "' (" + type_ + ")") {}

Change ChangeTopic::received(Change change) {
  ++received_;
  change.on_end = [this](Change::End how, const std::string& reason) { end(how, reason); };
  return change;
}

fiber_proximity::InputStatistics ChangeTopic::statistics(const ros::Time& now) const {
  fiber_proximity::InputStatistics statistics;
  statistics.topic = topic_;
  statistics.type = type_;
  statistics.received = received_;
  statistics.refused = refusals_.count();
  statistics.overtaken = overtaken_;
  statistics.dropped = -1;  // not counted
  statistics.age = applied_ > 0 ? (now - last_applied_).toSec() : -1.0;
  statistics.last_error = refusals_.last_error();
  return statistics;
}

void ChangeTopic::end(Change::End end, const std::string& reason) {
  switch (end) {
    case Change::End::APPLIED:
      ++applied_;
      last_applied_ = ros::Time::now();
      break;
    case Change::End::REFUSED:
      refusals_.refuse(reason);
      break;
    case Change::End::OVERTAKEN:
      ++overtaken_;
      break;
  }
}

}  // namespace fiber_proximity_ros
