# Node, nodelets, launch files, and what a catkin workspace installs.

add_library(fiber_proximity_ros SHARED
  src/ros/conversions.cpp
  src/ros/fiber_formats.cpp
  src/ros/fiber_player.cpp
  src/ros/markers.cpp
  src/ros/parameters.cpp
  src/ros/tube_mesh.cpp
)
target_include_directories(fiber_proximity_ros PUBLIC
  ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION} ${catkin_INCLUDE_DIRS})
target_link_libraries(fiber_proximity_ros
  PUBLIC fiber_proximity ${catkin_LIBRARIES} PRIVATE fiber_proximity_options)
add_dependencies(fiber_proximity_ros ${${PROJECT_NAME}_EXPORTED_TARGETS})

add_executable(fiber_player src/nodes/fiber_player.cpp)
target_link_libraries(fiber_player fiber_proximity_ros fiber_proximity_options)

install(TARGETS fiber_proximity fiber_proximity_ros
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION}
)
install(DIRECTORY include/${PROJECT_NAME}/
  DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION}
)
install(TARGETS fiber_player
  RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION}
)
