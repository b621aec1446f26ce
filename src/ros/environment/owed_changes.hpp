#pragma once

#include <ros/time.h>

#include <map>
#include <string>
#include <vector>

#include "src/ros/support/unknown.hpp"

namespace fiber_proximity_ros {

class TouchedObjects;

/// Obstacles that somebody has sent and that were refused: what is around the fibres is not known
/// until the obstacle is added anew or removed. A place that was refused is known once the obstacle
/// has been moved.
class OwedChanges {
 public:
  /// [obstacle] Of more than these only the topics are known; they are owed until all obstacles of
  /// such a topic are removed.
  static constexpr std::size_t max_obstacles = 1000;

  /// Notes that a change was refused. Obstacles that it should only have removed may be there
  /// still, but what is there is known.
  /// @param topic whose it was
  void refuse(const std::string& topic, const TouchedObjects& touched, const ros::Time& now,
              const std::string& reason);

  /// Notes that a change was made.
  /// @param topic whose removal of all obstacles is that of its own; empty: of all topics
  void settle(const std::string& topic, const TouchedObjects& touched);

  bool is_empty() const { return owed_.empty(); }
  std::vector<Unknown> unknown() const;

 private:
  struct Owed {
    Unknown unknown;
    bool is_of_place;  // and of nothing else
  };

  std::map<std::string, Owed> owed_;  // by what is unknown
};

}  // namespace fiber_proximity_ros
