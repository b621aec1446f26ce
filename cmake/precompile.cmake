# Headers that most of our sources include, parsed once a target instead of once a source: half of the
# time that building all of this takes.

option(FIBER_PROXIMITY_PRECOMPILE_HEADERS "Parse common headers once" ON)

set(core_headers
  <algorithm> <array> <cmath> <cstdint> <functional> <limits> <memory> <optional> <random> <stdexcept>
  <string> <utility> <vector> <Eigen/Geometry>)
set(fcl_headers ${core_headers} <fcl/fcl.h>)
set(ros_headers ${core_headers}
  <ros/ros.h> <tf2_ros/buffer.h> <tf2_ros/transform_listener.h> <sensor_msgs/PointCloud2.h>
  <visualization_msgs/MarkerArray.h> <yaml-cpp/yaml.h>)

# fiber_proximity_precompile(TARGET HEADER...)
function(fiber_proximity_precompile target)
  if(FIBER_PROXIMITY_PRECOMPILE_HEADERS)
    target_precompile_headers(${target} PRIVATE ${ARGN})
  endif()
endfunction()
