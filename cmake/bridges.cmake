# Nodes that bring in what MoveIt and octomap_server publish, where their messages are installed.
# Nothing else depends on them.

find_package(octomap_msgs QUIET)
if(octomap_msgs_FOUND)
  message(STATUS "octomap_msgs is installed: octomap_bridge is built")
  add_library(fiber_proximity_octomap STATIC
    src/ros/bridges/octomap_bridge.cpp
  )
  #catkin_lint: ignore_once external_interface_path
  target_include_directories(fiber_proximity_octomap SYSTEM PUBLIC ${octomap_msgs_INCLUDE_DIRS})
  target_link_libraries(fiber_proximity_octomap
    PUBLIC fiber_proximity_ros PRIVATE fiber_proximity_options)
  add_executable(octomap_bridge src/nodes/octomap_bridge_node.cpp)
  target_link_libraries(octomap_bridge fiber_proximity_octomap fiber_proximity_options)
  install(TARGETS octomap_bridge RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
else()
  message(STATUS "octomap_msgs is not installed: octomap_bridge is not built")
endif()

find_package(moveit_msgs 0.11 QUIET)  # in older ones objects have no pose
if(moveit_msgs_FOUND)
  message(STATUS "moveit_msgs is installed: moveit_bridge is built")
  add_library(fiber_proximity_moveit STATIC
    src/ros/bridges/moveit_bridge.cpp
  )
  #catkin_lint: ignore_once external_interface_path
  target_include_directories(fiber_proximity_moveit SYSTEM PUBLIC ${moveit_msgs_INCLUDE_DIRS})
  target_link_libraries(fiber_proximity_moveit
    PUBLIC fiber_proximity_ros PRIVATE fiber_proximity_options)
  add_executable(moveit_bridge src/nodes/moveit_bridge_node.cpp)
  target_link_libraries(moveit_bridge fiber_proximity_moveit fiber_proximity_options)
  install(TARGETS moveit_bridge RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})
else()
  message(STATUS "moveit_msgs 0.11 is not installed: moveit_bridge is not built")
endif()
