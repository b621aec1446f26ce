#include "src/ros/inputs/synchronizer.hpp"

namespace fiber_proximity_ros {

bool Synchronizer::accept(const Inputs& inputs, const ros::Time& now) {
  bool one_has_left = false;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (inputs[i]->is_silent(now)) {
      one_has_left = matcher_.leave_out(i) || one_has_left;
    }
  }
  std::vector<StampSet> sets = matcher_.take();
  // Inputs that waited for one that was left out have had no time to match yet.
  if (!sets.empty() || one_has_left || !matcher_.is_waiting()) {
    last_match_ = now;
  } else if ((now - last_match_).toSec() > input_timeout_) {
    matcher_.leave_out_farthest(now);
    sets = matcher_.take();
    last_match_ = now;
  }
  for (const StampSet& set : sets) {
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      if (set[i]) {
        inputs[i]->accept(*set[i]);
      }
    }
  }
  return !sets.empty();
}

void Synchronizer::reset(const ros::Time& now) {
  matcher_.reset();
  last_match_ = now;
}

}  // namespace fiber_proximity_ros
