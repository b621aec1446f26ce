# Node, nodelets, launch files, and what a catkin workspace installs.

add_library(fiber_proximity_ros SHARED
  src/ros/candidates.cpp
  src/ros/chain_set.cpp
  src/ros/change_topic.cpp
  src/ros/check_service.cpp
  src/ros/cloud_cells.cpp
  src/ros/cloud_input.cpp
  src/ros/cloud_options.cpp
  src/ros/cloud_worker.cpp
  src/ros/comparison_output.cpp
  src/ros/contact_array.cpp
  src/ros/contact_events.cpp
  src/ros/conversions.cpp
  src/ros/crossing_markers.cpp
  src/ros/crossings_output.cpp
  src/ros/detection.cpp
  src/ros/detector.cpp
  src/ros/diagnostics.cpp
  src/ros/dynamic_parameters.cpp
  src/ros/environment_inputs.cpp
  src/ros/environment_markers.cpp
  src/ros/environment_motion_detector.cpp
  src/ros/environment_options.cpp
  src/ros/environment_output.cpp
  src/ros/fiber_formats.cpp
  src/ros/fiber_player.cpp
  src/ros/fiber_step.cpp
  src/ros/fixed_frame.cpp
  src/ros/input.cpp
  src/ros/input_options.cpp
  src/ros/input_set.cpp
  src/ros/input_types.cpp
  src/ros/legend.cpp
  src/ros/marker_input.cpp
  src/ros/marker_obstacles.cpp
  src/ros/marker_scale.cpp
  src/ros/markers.cpp
  src/ros/mesh_loader.cpp
  src/ros/missing_points.cpp
  src/ros/motion_check.cpp
  src/ros/motion_detector.cpp
  src/ros/obstacle_change.cpp
  src/ros/obstacle_service.cpp
  src/ros/obstacle_set.cpp
  src/ros/parameters.cpp
  src/ros/point_cloud_input.cpp
  src/ros/pose_input.cpp
  src/ros/prediction_output.cpp
  src/ros/proximity_server.cpp
  src/ros/query_services.cpp
  src/ros/query_settings.cpp
  src/ros/refusal_log.cpp
  src/ros/robot_description.cpp
  src/ros/robot_links.cpp
  src/ros/scene_obstacles.cpp
  src/ros/segment_welder.cpp
  src/ros/server_options.cpp
  src/ros/sequence_gaps.cpp
  src/ros/shape_marker.cpp
  src/ros/shape_query.cpp
  src/ros/stamp_matcher.cpp
  src/ros/statistics_output.cpp
  src/ros/step_contacts.cpp
  src/ros/touched_objects.cpp
  src/ros/tube_mesh.cpp
  src/ros/tube_sweep.cpp
  src/ros/waiting_changes.cpp
  src/ros/worker.cpp
  src/ros/yaml_parameter.cpp
)
# The generated messages' headers, as the system's: our warnings are not meant for them.
#catkin_lint: ignore_once external_directory
#catkin_lint: ignore_once external_interface_path
target_include_directories(fiber_proximity_ros SYSTEM PUBLIC
  ${CATKIN_DEVEL_PREFIX}/${CATKIN_GLOBAL_INCLUDE_DESTINATION} ${catkin_INCLUDE_DIRS})
target_link_libraries(fiber_proximity_ros
  PUBLIC fiber_proximity_environment_scene fiber_proximity_fcl ${catkin_LIBRARIES}
  PRIVATE fiber_proximity_options)
fiber_proximity_parse_once(fiber_proximity_ros ${ros_headers})
# Not all exported targets: messages in other languages need not be there first.
add_dependencies(fiber_proximity_ros
  ${PROJECT_NAME}_generate_messages_cpp ${PROJECT_NAME}_gencfg)

add_executable(fiber_player src/nodes/fiber_player.cpp)
target_link_libraries(fiber_player fiber_proximity_ros fiber_proximity_options)

add_executable(proximity_node src/nodes/proximity_node.cpp)
target_link_libraries(proximity_node fiber_proximity_ros fiber_proximity_options)

fiber_proximity_compile_fast(fiber_proximity_ros fiber_player proximity_node)

install(TARGETS fiber_proximity fiber_proximity_environment fiber_proximity_environment_scene
    fiber_proximity_fcl fiber_proximity_ros
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
install(DIRECTORY config launch meshes rviz urdf DESTINATION ${CATKIN_PACKAGE_SHARE_DESTINATION})
catkin_install_python(PROGRAMS
  scripts/play_cell.py scripts/play_passing.py scripts/play_tracker.py scripts/print_contacts.py
  DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION}
)
