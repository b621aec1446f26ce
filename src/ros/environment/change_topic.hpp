#pragma once

#include <ros/time.h>

#include <cstdint>
#include <string>

#include "fiber_proximity/InputStatistics.h"
#include "src/ros/environment/waiting_changes.hpp"
#include "src/ros/inputs/refusal_log.hpp"

namespace fiber_proximity_ros {

/// A topic whose messages change the environment: counts what becomes of them.
class ChangeTopic {
 public:
  ChangeTopic(std::string topic, std::string type);

  /// Counts a message.
  /// @returns the change with what counts its end, too; this must outlive it
  Change received(Change change);

  fiber_proximity::InputStatistics statistics(const ros::Time& now) const;

 private:
  void end(Change::End end, const std::string& reason);

  std::string topic_;
  std::string type_;
  RefusalLog refusals_;
  std::uint64_t received_ = 0;
  std::uint64_t applied_ = 0;
  std::uint64_t overtaken_ = 0;
  ros::Time last_applied_;
};

}  // namespace fiber_proximity_ros
