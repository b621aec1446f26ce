#pragma once

#include <algorithm>
#include <memory>
#include <vector>

namespace fiber_proximity_ros {

/// Objects whose memory is used again once nobody else holds them. For one thread.
template <class Object>
class Pool {
 public:
  /// One that nobody holds, as it was left, or a new one.
  std::shared_ptr<Object> take() {
    const auto is_free = [](const std::shared_ptr<Object>& one) { return one.use_count() == 1; };
    const auto found = std::find_if(objects_.begin(), objects_.end(), is_free);
    if (found != objects_.end()) {
      return *found;
    }
    objects_.push_back(std::make_shared<Object>());
    return objects_.back();
  }

  /// Leaves an object to those who hold it, as when other threads do.
  void forget(const std::shared_ptr<Object>& object) {
    objects_.erase(std::remove(objects_.begin(), objects_.end(), object), objects_.end());
  }

  /// Leaves all of them to those who hold them.
  void clear() { objects_.clear(); }

 private:
  std::vector<std::shared_ptr<Object>> objects_;
};

}  // namespace fiber_proximity_ros
