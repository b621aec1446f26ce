#include "fiber_proximity/ros/detection.hpp"

#include <algorithm>
#include <limits>

#include "fiber_proximity/query/deadline.hpp"
#include "fiber_proximity/ros/stopwatch.hpp"

namespace fiber_proximity_ros {

void Detection::detect(const fiber::QueryOptions& options, bool wants_minimum, const Ask& ask) {
  const Stopwatch stopwatch;
  const fiber::Deadline deadline(options.deadline);
  ask(options, contacts_);
  counts_ = contacts_.counts;
  complete_ = contacts_.complete;
  // The first contact found need not be the closest.
  minimum_ = options.type == fiber::QueryType::FIRST ? nullptr : contacts_.closest();
  minimum_lower_ = contacts_.minimum_lower();
  contact_time_ = stopwatch.seconds();
  if (minimum_ == nullptr && wants_minimum) {
    fiber::QueryOptions closest = options;
    closest.type = fiber::QueryType::CLOSEST;
    closest.margin = std::numeric_limits<double>::infinity();
    closest.deadline = deadline.left();
    ask(closest, closest_);
    complete_ = complete_ && closest_.complete;
    minimum_ = closest_.closest();
    minimum_lower_ = closest_.minimum_lower();
    counts_ += closest_.counts;
  }
  minimum_time_ = stopwatch.seconds() - contact_time_;
}

double Detection::contact_error() const {
  double error = 0.0;
  for (const fiber::Contact& contact : contacts_.contacts) {
    error = std::max(error, contact.upper - contact.distance);
  }
  return error;
}

double Detection::minimum_upper() const {
  return minimum_ == nullptr ? std::numeric_limits<double>::infinity() : minimum_->upper;
}

}  // namespace fiber_proximity_ros
