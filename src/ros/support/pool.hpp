#pragma once

#include <algorithm>
#include <memory>
#include <vector>

namespace fiber_proximity_ros {

/// Objects whose memory is used again once nobody else holds them. For one thread; others may hold
/// them if Pointer counts for several, as boost's does.
template <class Object, template <class> class Pointer = std::shared_ptr>
class Pool {
 public:
  /// One that nobody holds, as it was left, or a new one.
  Pointer<Object> take() {
    const auto is_free = [](const Pointer<Object>& one) { return one.use_count() == 1; };
    const auto found = std::find_if(objects_.begin(), objects_.end(), is_free);
    if (found != objects_.end()) {
      return *found;
    }
    objects_.push_back(Pointer<Object>(std::make_unique<Object>()));
    return objects_.back();
  }

  /// Leaves an object to those who hold it, as when other threads do.
  void forget(const Pointer<Object>& object) {
    objects_.erase(std::remove(objects_.begin(), objects_.end(), object), objects_.end());
  }

  /// Leaves all of them to those who hold them.
  void clear() { objects_.clear(); }

  std::size_t size() const { return objects_.size(); }

 private:
  std::vector<Pointer<Object>> objects_;
};

}  // namespace fiber_proximity_ros
