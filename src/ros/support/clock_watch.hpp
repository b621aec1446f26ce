#pragma once

#include <ros/console.h>
#include <ros/time.h>

namespace fiber_proximity_ros {

/// Warns where time stands still: /use_sim_time is set, left by an earlier launch perhaps, and
/// nothing publishes /clock. To be asked every now and then, by wall time.
class ClockWatch {
 public:
  void look() {
    constexpr double patience = 5.0;  // [s] of wall time that whoever publishes /clock may take
    if (is_told_ || !ros::Time::isSimTime() || !ros::Time::now().isZero() ||
        (ros::SteadyTime::now() - begin_).toSec() < patience) {
      return;
    }
    is_told_ = true;
    ROS_WARN_STREAM(
        "time stands still: the parameter /use_sim_time is true, and nothing publishes "
        "/clock. `rosparam set /use_sim_time false` makes it go on for nodes that are "
        "started then");
  }

 private:
  ros::SteadyTime begin_ = ros::SteadyTime::now();
  bool is_told_ = false;
};

}  // namespace fiber_proximity_ros
