# Node, nodelets, launch files, and what a catkin workspace installs.

add_library(fiber_proximity_ros SHARED
  src/ros/chain_set.cpp
  src/ros/conversions.cpp
  src/ros/detector.cpp
  src/ros/diagnostics.cpp
  src/ros/fiber_formats.cpp
  src/ros/fiber_player.cpp
  src/ros/fixed_frame.cpp
  src/ros/input.cpp
  src/ros/input_options.cpp
  src/ros/input_set.cpp
  src/ros/input_types.cpp
  src/ros/marker_input.cpp
  src/ros/markers.cpp
  src/ros/parameters.cpp
  src/ros/point_cloud_input.cpp
  src/ros/pose_input.cpp
  src/ros/proximity_server.cpp
  src/ros/segment_welder.cpp
  src/ros/server_options.cpp
  src/ros/shape_query.cpp
  src/ros/tube_mesh.cpp
)
target_include_directories(fiber_proximity_ros SYSTEM PUBLIC
  ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION} ${catkin_INCLUDE_DIRS})
target_link_libraries(fiber_proximity_ros
  PUBLIC fiber_proximity ${catkin_LIBRARIES} PRIVATE fiber_proximity_options)
add_dependencies(fiber_proximity_ros ${${PROJECT_NAME}_EXPORTED_TARGETS})

add_executable(fiber_player src/nodes/fiber_player.cpp)
target_link_libraries(fiber_player fiber_proximity_ros fiber_proximity_options)

add_executable(proximity_node src/nodes/proximity_node.cpp)
target_link_libraries(proximity_node fiber_proximity_ros fiber_proximity_options)

add_library(fiber_proximity_nodelets SHARED src/nodes/nodelets.cpp)
target_link_libraries(fiber_proximity_nodelets
  PUBLIC fiber_proximity_ros PRIVATE fiber_proximity_options)

install(TARGETS fiber_proximity fiber_proximity_ros fiber_proximity_nodelets
  ARCHIVE DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  LIBRARY DESTINATION ${CATKIN_PACKAGE_LIB_DESTINATION}
  RUNTIME DESTINATION ${CATKIN_GLOBAL_BIN_DESTINATION}
)
install(TARGETS fiber_player proximity_node
  RUNTIME DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION}
)
install(FILES nodelet_plugins.xml DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
install(DIRECTORY include/${PROJECT_NAME}/
  DESTINATION ${CATKIN_PACKAGE_INCLUDE_DESTINATION}
)
install(DIRECTORY config launch rviz DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
catkin_install_python(PROGRAMS scripts/print_contacts.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION}
)
