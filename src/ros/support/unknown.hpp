#pragma once

#include <ros/time.h>

#include <string>
#include <vector>

namespace fiber_proximity_ros {

/// Something that answers are asked about and that is not known: an input without fresh fibres, a
/// link without a transform, a cloud that has not come, an obstacle that was refused.
struct Unknown {
  std::string source;  ///< where it should come from, as /diagnostics names it
  std::string what;    ///< stays the same while it lasts
  ros::Time since;     ///< when it was known last, or first asked about
  std::string why;
  bool is_logged = false;  ///< its source has told the log
};

/// On one line, as answers have it: "robot/arm since 12.5: no transform from …".
std::string text_of(const Unknown& unknown);

/// Adds one list to another.
inline void append(const std::vector<Unknown>& more, std::vector<Unknown>& all) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace fiber_proximity_ros
