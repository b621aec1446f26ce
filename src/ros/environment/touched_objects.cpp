#include "src/ros/environment/touched_objects.hpp"

#include <algorithm>

namespace fiber_proximity_ros {

void TouchedObjects::add(const std::string& name) { names_.insert(name); }

void TouchedObjects::remove(const std::string& name) {
  if (names_.insert(name).second) {
    removed_first_.insert(name);
  }
}

void TouchedObjects::remove_all() {
  removes_everything_first_ = removes_everything_first_ || (names_.empty() && !is_everything_);
  is_everything_ = true;
}

bool TouchedObjects::overlaps(const TouchedObjects& other) const {
  return is_everything_ || other.is_everything_ ||
         std::any_of(names_.begin(), names_.end(),
                     [&other](const std::string& name) { return other.names_.count(name) > 0; });
}

bool TouchedObjects::is_undone_by(const TouchedObjects& later) const {
  const auto& removed = later.removed_first_;
  return later.removes_everything_first_ ||
         (!is_everything_ &&
          std::includes(removed.begin(), removed.end(), names_.begin(), names_.end()));
}

}  // namespace fiber_proximity_ros
