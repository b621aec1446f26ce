#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "src/ros/outputs/marker_canvas.hpp"

namespace fiber_proximity_rviz {

/// The texts among markers that belong to no place: the legend, and what an answer lacks.
class MarkerTexts {
 public:
  /// Takes what a message adds, modifies and deletes.
  void take(const visualization_msgs::MarkerArray& message);

  void clear() { texts_.clear(); }

  /// The lines: first what an answer lacks, then the legend from its first line on.
  std::vector<fiber_proximity_ros::LegendLine> lines() const;

 private:
  std::map<std::string, std::map<std::int32_t, fiber_proximity_ros::LegendLine>> texts_;
};

}  // namespace fiber_proximity_rviz
