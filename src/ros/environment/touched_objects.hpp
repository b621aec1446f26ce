#pragma once

#include <set>
#include <string>

namespace fiber_proximity_ros {

/// Which objects a change touches, and which of them it removes before anything else.
class TouchedObjects {
 public:
  /// Notes the next step of the change.
  void add(const std::string& name);
  void remove(const std::string& name);
  void remove_all();

  const std::set<std::string>& names() const { return names_; }
  bool is_everything() const { return is_everything_; }

  /// Whether it could undo another change.
  bool begins_with_removal() const { return removes_everything_first_ || !removed_first_.empty(); }

  /// Whether the order of the two changes matters.
  bool overlaps(const TouchedObjects& other) const;

  /// Whether nothing is left of this change once the later one has been made.
  bool is_undone_by(const TouchedObjects& later) const;

 private:
  std::set<std::string> names_;
  std::set<std::string> removed_first_;  // of these names
  bool is_everything_ = false;
  bool removes_everything_first_ = false;
};

}  // namespace fiber_proximity_ros
